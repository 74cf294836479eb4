#!/usr/bin/env python3
"""What pages and help say that the program does not do: a sentence that denies a section of the case, a key or a format must be true.

A sentence is looked at if it denies ("no", "not", "cannot", ...) something of a name that the case or a table of formats knows. Denials
of reading or writing a format are compared with the tables. All others have to be in tests/reviewed_claims.txt, with the reason why
they are true; entries there that no sentence needs any more are errors too.

usage: check_claims.py SOURCE_DIR | check_claims.py --self-test
"""
import pathlib
import re
import sys
import tempfile

REVIEWED = "tests/reviewed_claims.txt"
# Names in plain words, of sections and keys and of what they make. Names of keys are common words: in code marks they count.
FEATURES = {
    "layers": r"(?:boundary )?layers|prisms|pyramids", "farfield": r"far fields?|half models?", "groups": r"groups",
    "patches": r"patches", "sources": r"size sources|wakes", "level": r"levels", "checkpoints": r"checkpoints|resum(?:e|ing)",
    "pictures": r"pictures", "trailing_edges": r"trailing edges", "gate": r"gates?|limits on quality", "compression": r"compression",
    "parts": r"parts", "expression": r"expressions|formulas?", "reference_length": r"reference lengths?", "walls": r"bands",
    "improve": r"improvement", "sandbox": r"sandbox(?:es)?", "narrow_faces": r"narrow faces",
}
# Formats, by the name in sentences: the names in the tables of the sources.
FORMATS = {
    "STL": "stl", "OBJ": "obj", "OFF": "off", "PLY": "ply", "STEP": "STEP", "IGES": "IGES", "BREP": "BREP", "VTU": "vtu",
    "VTKHDF": "vtkhdf", "CGNS": "cgns", "UGRID": "ugrid", "SU2": "su2", "MSH": "msh", "Medit": "meshb", "OpenFOAM": "foam",
}
# The tables: what a file of the table is called, and its rows.
WRITTEN = ("file_formats.cpp", re.compile(r'\.ends = \{"[^"]*\.(\w+)"'))
READ = [("file_formats.cpp", re.compile(r'\{"\.(\w+)", "[^"]+"\}')), ("read_facets.cpp", re.compile(r'\{"\.(\w+)", read_\w+\}')),
        ("cad_reader.cpp", re.compile(r'return "([A-Z]+)";'))]
EXPORTED = {"STEP": "export_cad_command.cpp"}  # what a command writes that no table has

OF_DEVELOPERS = {"tests", "benchmarks", "examples"}
# Messages about one file, whatever the program can do with others.
ONE_FILE = re.compile(r"\bno (?:\w+ )?\w+ (?:file|mesh)\b|\b(?:an?|binary) [A-Z]+ files? (?:that|are)\b|a type that")

NEGATION = r"(?:no|not|cannot|never|neither|nor|without|unsupported|unknown)"
DOES = r"(?:read|write|written|make|made|mesh|support|know|accept|take|have|export|import|handle|offer|provide|include|generate|build|do)\w*"
# A condition denies nothing: "where there is no checkpoint".
CONDITION = re.compile(r"(?i:\b(?:where|if|when|while|unless)) (?:there )?(?:is|are|has|have) no [^.,;]*")
KEY = re.compile(r"\| `([a-zA-Z_.]+)` \|")
CODE = re.compile(r"`([^`]*)`")
LITERALS = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def denials(term, flags=0):
    """Patterns of sentences that deny the term."""
    return [re.compile(pattern, flags) for pattern in (
        rf"(?i:\bno )(?:[\w-]+,? ){{0,3}}(?:{term})\b",
        rf"\b(?:{term})\b(?:,? (?:or |and )?[\w-]+){{0,4}}[,)]? (?:is|are|can|do|does|has|have) (?:\w+ )?(?:not|never|neither|none)\b",
        rf"\b(?:{term})\b(?: [\w-]+){{0,3}} cannot\b",
        rf"\b(?:{term})\b[^.]*?\b(?:read|written|made|supported),? (?:but )?not\b",
        rf"(?i:\bcannot|\b(?:does|do|can|is|are) not|\bnever|\bneither|\bnot)(?: [\w-]+){{0,2}} {DOES}(?: [\w,-]+){{0,5}} (?:{term})\b",
        rf"(?i:\bunsupported|\bunknown to)[^.]*\b(?:{term})\b",
    )]


FORMAT_DENIALS = {name: denials(name) for name in FORMATS}
FEATURE_DENIALS = {name: denials(words, re.IGNORECASE) for name, words in FEATURES.items()}


def find(root, name):
    return [path for path in sorted(root.rglob(name)) if "build" not in path.relative_to(root).parts]


def rows_of(root, name, pattern):
    rows = {row for path in find(root, name) for row in pattern.findall(path.read_text())}
    if not rows:
        raise SystemExit(f"check_claims.py: no table of formats in {name} any more; name the new one here")
    return rows


def formats(root):
    """Names of formats in the tables, read and written."""
    read = set().union(*(rows_of(root, *table) for table in READ))
    written = rows_of(root, *WRITTEN) | {name for name, file in EXPORTED.items() if find(root, file)}
    return read, written


def keys_of(root):
    """All keys of the case and their sections, from the reference that the program writes."""
    keys = set()
    for page in sorted((root / "docs/configuration").glob("*.md")):
        for path in KEY.findall(page.read_text()):
            keys.add(path)
            keys.update(path[:i] for i, c in enumerate(path) if c == ".")
    return keys


def paragraphs(text):
    """Of a page, without code blocks; each cell of a table and each item of a list is one."""
    fenced, lines = False, []
    for line in [*text.splitlines(), ""]:
        if line.lstrip().startswith("```"):
            fenced, line = not fenced, ""
        elif fenced:
            continue
        starts = not line.strip() or line.startswith(("#", "|", "<!--")) or re.match(r"\s*(?:[-*]|\d+\.) ", line)
        if starts and lines:
            yield " ".join(lines)
            lines = []
        if line.startswith("|"):
            yield from (cell.strip() for cell in line.strip("|").split(" | "))
        elif line.strip() and not line.startswith(("#", "<!--")):
            lines.append(re.sub(r"^\s*(?:[-*]|\d+\.) ", "", line).strip())


def sentences(paragraph):
    plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", paragraph).replace("*", "")
    return re.split(r"(?<=[.;:!?])\s+", plain)


def texts(root):
    """Every sentence of pages, help and messages, with its file, and whether it is of a message."""
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    for page in (page for page in pages if page.exists()):
        for paragraph in paragraphs(page.read_text()):
            for sentence in sentences(paragraph):
                yield page, sentence, False
    for source in find(root, "*.cpp"):
        if source.relative_to(root).parts[0] in OF_DEVELOPERS:
            continue
        is_message = source.name != "command_line.cpp" and source.parent.name != "commands" and not source.name.startswith("html_")
        for run in LITERALS.findall(source.read_text()):
            for sentence in sentences("".join(LITERAL.findall(run)).replace("\\n", " ")):
                yield source, sentence.strip(), is_message


def holds_of_format(sentence, name, read, written):
    """Whether the tables confirm the denial; None where the sentence is about something else."""
    asks_read = re.search(r"\b(?:reads?|input)\b", sentence)
    asks_write = re.search(r"\b(?:writes?|written|export\w*)\b", sentence)
    is_read, is_written = FORMATS[name] in read, FORMATS[name] in written
    if re.search(r"\bwritten\b[^.]*\bnot read\b", sentence):
        return is_written and not is_read
    if re.search(r"\bread\b[^.]*\bnot written\b", sentence):
        return is_read and not is_written
    if asks_read and not asks_write:
        return not is_read
    if asks_write and not asks_read:
        return not is_written
    return False if not asks_read and not asks_write and is_read else None


def claims(root):
    """Sentences that deny something of a known name and that no table confirms."""
    read, written = formats(root)
    keys = keys_of(root)
    sections = {key for key in keys if "." not in key}
    for file, sentence, is_message in texts(root):
        said, sentence = sentence, CONDITION.sub("", sentence)
        if not re.search(rf"(?i:\b{NEGATION}\b)", sentence):
            continue
        denied = [name for name, patterns in FORMAT_DENIALS.items() if any(p.search(sentence) for p in patterns)]
        verdicts = [holds_of_format(sentence, name, read, written) for name in denied]
        if denied and all(verdict is True for verdict in verdicts):
            continue
        if is_message:  # says what is wrong with one file: only formats are of interest
            if denied and not ONE_FILE.search(sentence):
                yield file, said, denied
            continue
        denied += [name for name, patterns in FEATURE_DENIALS.items() if any(p.search(sentence) for p in patterns)]
        for code in CODE.findall(sentence):
            path = code.split(":")[0].strip()
            if path in keys and (path in sections or "." in path):
                marked = sentence.replace(f"`{code}`", "TERM")
                denied += [path] if any(p.search(marked) for p in denials("TERM")) else []
        if denied:
            yield file, said, denied


def reviewed(root):
    """Sentences, each with its reason on the next, indented line."""
    path = root / REVIEWED
    entries, sentence = {}, ""
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.startswith("#") or not line.strip():
            continue
        if line.startswith(" ") and sentence:
            entries[sentence] = line.strip()
        else:
            sentence = line.strip()
            entries[sentence] = ""
    return entries


def violations(root):
    entries, used, found = reviewed(root), set(), []
    for file, sentence, denied in claims(root):
        if sentence in entries:
            used.add(sentence)
        else:
            found.append(f"{file.relative_to(root)}: '{sentence}' denies {', '.join(denied)}: mend it, or put it into {REVIEWED}"
                         " with the reason why it is true")
    found += [f"{REVIEWED}: no page says any more: '{sentence}'" for sentence in entries if sentence not in used]
    found += [f"{REVIEWED}: no reason is given for '{sentence}'" for sentence, reason in entries.items() if not reason]
    return found


SOURCES = {
    "io/file_formats.cpp": '.ends = {".cgns"},\n.ends = {".su2"},\n.readable_ends = {{{".su2", "SU2, text"}}},\n',
    "cad/read_facets.cpp": '{{".stl", read_stl}}\n',
    "cad/cad_reader.cpp": 'return "STEP";\n',
    "docs/configuration/layers.md": "| `layers.first` | – | number | Height. |\n| `improve.gate.min` | – | number | Least. |\n",
}


def self_test():
    clean = {
        "docs/a.md": "CGNS is written, not read. Aeroloom does not read CGNS.\nThe far field is a sphere, not a box.\n"
                     "A gap of no width is an error. It starts again where there are no checkpoints.\n\n```\nthere are no boundary layers\n```\n",
        "pipeline/commands/b.cpp": 'say("layers of prisms on walls");\n',
        "io/m.cpp": 'fail("this is no STL file: it ends too early; cells are not read");\n',
        "docs/c.md": "Faces between regions have no layers.\n",
        REVIEWED: "Faces between regions have no layers.\n  layers/build.cpp leaves them out\n",
    }
    planted = {
        "pipeline/commands/command_line.cpp": 'text =\n  "An isotropic mesher.\\n"\n  "There are no boundary layers: all elements are "\n  "tetrahedra.";\n',
        "docs/d.md": "- There is no STL, OFF input.\n",
        "docs/e.md": "The program cannot read SU2.\n",
        "docs/f.md": "SU2 is written, not read.\n",
        "docs/g.md": "CGNS is not written.\n",
        "docs/h.md": "| gaps | boundary layers are not supported |\n",
        "docs/i.md": "The section `layers` is not there yet.\n",
        "docs/j.md": "Half models cannot be\nmeshed. More.\n",
        "docs/k.md": "It does not make prisms.\n",
        "docs/l.md": "`improve.gate.min` is not checked.\n",
        "cad/n.cpp": 'fail("{}: export STEP; triangles (OBJ, "\n "STL) are not read", file);\n',
    }
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for group in (SOURCES, clean, planted):
            for file, text in group.items():
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(text)
            if group is clean:
                assert violations(root) == [], violations(root)
        found = violations(root)
        for file in planted:
            assert sum(each.startswith(file + ":") for each in found) == 1, f"{file}: {found}"
        (root / REVIEWED).write_text("Nobody says so.\n  a reason\nFaces between regions have no layers.\n")
        found = violations(root)
        assert any("no page says" in each for each in found) and any("no reason" in each for each in found), found


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    found = violations(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found) if found else "claims: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
