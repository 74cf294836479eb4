"""Tables of measured figures on the pages in benchmarks/results/.

A page has a section for each table, under a heading of its own:

    ## Heading

    words by hand

    <!-- table -->
    note

    | column | ... |
    <!-- end of table -->

A benchmark replaces what stands between the markers, and nothing else: words around them stay.
"""
import pathlib
import re

BEGIN, END = "<!-- table -->", "<!-- end of table -->"


def write_table(page: pathlib.Path, heading: str, columns: list[str], rows: list[list[str]], note: str = "") -> None:
    """Replaces the table under that heading of the page; adds the section, or the page, where it is not there."""
    if short := [row for row in rows if len(row) != len(columns)]:
        raise ValueError(f"'{heading}' has {len(columns)} columns, a row has {len(short[0])}: {short[0]}")
    lines = [note, ""] if note else []
    lines += ["| " + " | ".join(cells) + " |" for cells in (columns, *rows)]
    lines.insert(len(lines) - len(rows), "|" + "---|" * len(columns))
    block = "\n".join([BEGIN, *lines, END])
    page = pathlib.Path(page)
    text = page.read_text() if page.exists() else f"# {page.stem}\n"
    begin, end = find_section(text, heading)
    if begin is None:
        text = f"{text.rstrip()}\n\n## {heading}\n\n{block}\n"
    else:
        section, count = re.subn(f"{re.escape(BEGIN)}.*?{re.escape(END)}", lambda _: block, text[begin:end], count=1, flags=re.DOTALL)
        if not count:
            section = f"{section.rstrip()}\n\n{block}\n" + ("\n" if text[end:] else "")
        text = text[:begin] + section + text[end:]
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(text)


def find_section(text, heading):
    """Where the section begins and ends, its heading included; None and None where there is none."""
    found = re.search(rf"^## {re.escape(heading)}$", text, re.MULTILINE)
    if not found:
        return None, None
    after = re.search(r"^#{1,2} ", text[found.end():], re.MULTILINE)
    return found.start(), found.end() + after.start() if after else len(text)
