#!/usr/bin/env python3
"""The field's words: names, comments, texts and pages use those of the glossary (docs/architecture.md).

usage: check_words.py SOURCE_DIR | check_words.py --self-test
"""
import pathlib
import re
import subprocess
import sys
import tempfile

# Words that only builders of this program knew, and what is said instead. Words within names count too.
BANNED = {
    "token": "shared-vertex key",
    "wish": "claim",
    "giver": "donor",
    "taker": "receiver",
    "contained run": "sandboxed run",
    "contained task": "sandboxed task",
    "contained child": "sandboxed child",
    "dealt out": "scheduled, or distributed",
    "deal out": "schedule, or distribute",
    "deals out": "schedules, or distributes",
    "sabotage": "injected fault",
    "mate": "twin",
    "foreign": "imported",
    "comer": "candidate",
    "misfit": "unmatched face",
    "passage": "coedge",
    "settle": "what it does: project, resolve, converge",
    "containment": "sandbox",
    "told apart": "classified, or distinguished",
    "subface": "piece problem",
    "dealer": "distributor",
}
# Where a word means something else: the tokens of a text file; words in texts of others.
ALLOWED = {
    "token": ("io/gmsh/", "io/su2/", "tests/io/", "tests/cluster/", "scripts/"),
    "mate": ("cmake/",),
    "foreign": ("scripts/", "benchmarks/mutations.py"),
    "subface": ("geometry/unite_surfaces.cpp", "volume/filling/tetgen_run.cpp"),
}
SUFFIXES = {".cpp", ".hpp", ".md", ".py"}
EXEMPT = {"CHANGELOG.md", "tests/check_words.py"}


def pattern(word):
    """The word, its plural, and as part of a name in either way of writing names."""
    plain = word.replace(" ", r"[ _]")
    capital = "".join(part.capitalize() for part in word.split())
    return re.compile(rf"(?<![A-Za-z])(?i:{plain})(?i:e?s)?(?![a-z])|{capital}(?:e?s)?(?![a-z])")


PATTERNS = {word: pattern(word) for word in BANNED}
# Most lines have none of the words even as letters within others.
LETTERS = re.compile("|".join(word.replace(" ", "[ _]?") for word in BANNED), re.IGNORECASE)


def files(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files"], capture_output=True, text=True, check=False).stdout.split("\n")
    if not any(listed):
        listed = [str(path.relative_to(root)) for path in sorted(root.rglob("*")) if "build" not in path.parts]
    return [name for name in listed if pathlib.Path(name).suffix in SUFFIXES and name not in EXEMPT]


def violations(root):
    found = []
    for name in files(root):
        path = root / name
        if not path.is_file():
            continue
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            if not LETTERS.search(line):
                continue
            for word, regex in PATTERNS.items():
                if any(name.startswith(prefix) for prefix in ALLOWED.get(word, ())):
                    continue
                if regex.search(line):
                    found.append(f"{name}:{number}: '{word}': say {BANNED[word]}")
    return found


def self_test():
    planted = {
        "mesh/a.cpp": "std::vector<int> shared_tokens;\n",
        "mesh/b.hpp": "struct Wish {};\n",
        "mesh/c.cpp": "// pieces are dealt out by load\n",
        "docs/d.md": "TetGen works in a contained run.\n",
        "geometry/e.hpp": "int mate(int edge);\n",
        "surface/f.hpp": "struct SharedToken {};\n",
        "improve/j.cpp": "void settle_boundary();\n",
    }
    clean = {
        "mesh/g.cpp": "// about, estimate, material, automated, a newcomer\n",
        "io/gmsh/h.cpp": "std::string token;\n",
        "mesh/i.hpp": "struct VertexKey {};\n",
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
            assert any(each.startswith(file + ":") for each in found), f"missed {file}"


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "words: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
