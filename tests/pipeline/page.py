"""What must hold of a report.html, by the parser of Python's library."""
import html.parser
import re

VOID = {"meta", "img", "br", "hr", "link", "input"}
MOST_BYTES = 5_000_000


class Page(html.parser.HTMLParser):
    """Collects what is wrong with a page, and its text."""

    def __init__(self, file):
        super().__init__(convert_charrefs=True)
        self.wrong, self.open, self.ids, self.links, self.words, self.tags = [], [], [], [], [], set()
        content = file.read_bytes()
        if len(content) > MOST_BYTES:
            self.wrong.append(f"{len(content)} bytes")
        self.source = content.decode("utf-8")
        self.feed(self.source)
        self.close()
        self.finish()

    def handle_starttag(self, tag, attributes):
        self.look_at(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.look_at(tag, attributes)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> at {self.getpos()} ends what is not open")

    def handle_data(self, text):
        self.words.append(text)
        if self.open and self.open[-1] == "style" and re.search(r"@import|url\s*\(|expression", text):
            self.wrong.append("the style sheet names something outside")

    def look_at(self, tag, attributes):
        self.tags.add(tag)
        if tag in {"script", "link", "iframe", "object", "embed", "base", "form"}:
            self.wrong.append(f"<{tag}> at {self.getpos()}")
        for name, value in attributes:
            value = value or ""
            if name.startswith("on"):
                self.wrong.append(f"{tag} has {name} at {self.getpos()}")
            if name in {"src", "srcset", "poster", "data", "action"} and not value.startswith("data:image/png;base64,"):
                self.wrong.append(f"{tag} takes {name}={value[:60]}")
            if name in {"href", "xlink:href"}:
                self.links.append(value)
            if name == "style":
                self.wrong.append(f"{tag} has a style of its own")
            if name == "id":
                self.ids.append(value)

    def finish(self):
        if self.open:
            self.wrong.append(f"never ended: {self.open}")
        if len(set(self.ids)) < len(self.ids):
            self.wrong.append(f"an id stands twice: {self.ids}")
        self.wrong += [f"a link to {link}" for link in self.links if link[:1] != "#" or link[1:] not in self.ids]
        # The names of SVG and HTML need no address; a configuration may hold one as text.
        if re.search(r"<[^>]*https?:", self.source):
            self.wrong.append("an element names an address")
        self.text = " ".join(" ".join(self.words).split())
