#!/usr/bin/env python3
"""Links of the pages: every relative link of a Markdown file leads to a file, and its anchor to a heading there. Pages that
sources name (docs/usage.md) exist too. Addresses of other hosts are not asked for.

usage: check_links.py SOURCE_DIR | check_links.py --self-test
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.parse

FENCE = re.compile(r"^\s*(```|~~~)")
CODE = re.compile(r"(`+).+?\1")
# [text](target "title"), ![text](target), [text]: target, <img src="target">.
LINKS = [re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)"),
         re.compile(r"^\s*\[[^\]]+\]:\s+(\S+)"),
         re.compile(r"<(?:a|img)\s[^>]*?(?:href|src)=\"([^\"]+)\"")]
HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*\s*$")
ANCHOR = re.compile(r"<a\s[^>]*?(?:id|name)=\"([^\"]+)\"")
OTHER_HOST = re.compile(r"^[a-z][a-z0-9+.-]*:|^//", re.IGNORECASE)
# A page of docs/ as sources, cases and scripts name it.
NAMED_PAGE = re.compile(r"(?<![\w/.])docs/[\w/.-]*?\w\.md\b")
NAMING = {".cpp", ".hpp", ".py", ".sh", ".yaml", ".cmake", ".txt", ".md"}
# Self-tests plant pages that are not there.
MADE_UP = {"tests/check_links.py", "tests/check_words.py", "tests/check_claims.py", "tests/pipeline/case/case_template_test.cpp"}


def tracked(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, text=True, check=False).stdout.splitlines()
    if not listed:
        listed = [str(path.relative_to(root)) for path in sorted(root.rglob("*")) if path.is_file()]
    return [name for name in listed if "build/" not in name and (root / name).is_file()]


def prose(text):
    """The lines that are not of code blocks, by number, without code in them."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            yield number, line


def slug(heading):
    """The anchor that a viewer makes of a heading."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    text = re.sub(r"[^\w\- ]", "", text.strip().lower())
    return text.replace(" ", "-")


def anchors(text):
    """All anchors of a page; the second of equal headings gets -1."""
    found, times = set(), {}
    for _, line in prose(text):
        found.update(ANCHOR.findall(line))
        heading = HEADING.match(line)
        if heading:
            name = slug(heading.group(2))
            found.add(f"{name}-{times[name]}" if name in times else name)
            times[name] = times.get(name, 0) + 1
    return found


def links(text):
    for number, line in prose(text):
        plain = CODE.sub("", line)
        for pattern in LINKS:
            for target in pattern.findall(plain):
                yield number, target


def fault(root, page, target, known):
    """What is wrong with a link of a page, empty if nothing is."""
    place, _, anchor = urllib.parse.unquote(target).partition("#")
    base = root if place.startswith("/") else page.parent
    path = (base / place.lstrip("/")).resolve() if place else page.resolve()
    if not path.exists():
        return "is not there"
    if not path.is_relative_to(root.resolve()):
        return "leads out of the repository"
    if not anchor or path.suffix != ".md":
        return ""
    if path not in known:
        known[path] = anchors(path.read_text())
    return "" if anchor in known[path] else "has no such heading"


def violations(root):
    found, known = [], {}
    for name in tracked(root):
        path = root / name
        if path.suffix == ".md":
            for number, target in links(path.read_text()):
                if OTHER_HOST.match(target):
                    continue
                wrong = fault(root, path, target, known)
                if wrong:
                    found.append(f"{name}:{number}: {target} {wrong}")
        if path.suffix in NAMING and name not in MADE_UP:
            for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
                for page in NAMED_PAGE.findall(LINKS[0].sub("", line)):
                    if not (root / page).exists() and not (path.parent / page).exists():
                        found.append(f"{name}:{number}: {page} is not there")
    return found


def self_test():
    clean = {
        "docs/a.md": "# One `key`\n\n## Two, three\n\n## Two, three\n\n[b](b.md#b-c) [self](#one-key) [again](a.md#two-three-1)\n"
                     "![p](p%20q.png) [web](https://example.org/x#y) `[code](no.md)`\n\n```\n[code](no.md)\n# no heading\n```\n",
        "docs/b.md": "# b [c](a.md)\n\n[up](../README.md) [folder](../docs) <a id=\"own\"></a> [own](#own)\n\n[ref]: a.md\n",
        "docs/p q.png": "",
        "README.md": "[docs](docs/a.md)\n",
        "src/x.cpp": "// docs/a.md says why\n",
    }
    planted = {
        "docs/c.md": "[gone](gone.md)\n",
        "docs/d.md": "[anchor](a.md#four)\n",
        "docs/e.md": "text\n[self](#nowhere)\n",
        "docs/f.md": "![picture](pictures/none.png)\n",
        "docs/g.md": "[out](../../../../etc/passwd)\n",
        "docs/h.md": "[code](a.md#no-heading)\n",
        "docs/i.md": "[ref]: gone.md\n",
        "src/y.cpp": "// docs/gone.md says why\n",
    }
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for group in (clean, planted):
            for file, text in group.items():
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(text)
            if group is clean:
                assert violations(root) == [], violations(root)
        found = violations(root)
        for file in planted:
            assert sum(each.startswith(file + ":") for each in found) == 1, f"{file}: {found}"
        assert len(found) == len(planted), found


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "links: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
