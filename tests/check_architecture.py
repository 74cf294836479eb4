#!/usr/bin/env python3
"""Checks the architecture: includes point down, third-party headers stay in their room, no function has more than
six parameters, no two headers define types of one name.

usage: check_architecture.py SOURCE_DIR | check_architecture.py --self-test
"""
import pathlib
import re
import sys
import tempfile

# What each stage may include, besides itself.
STAGE = {"geometry", "cad", "forest", "front", "parallel", "mesh", "cavities", "sizing", "partition"}
# What what is made of stages may include.
STAGES = STAGE | {"attribution", "surface", "layers", "volume", "improve", "io"}
# What each folder may include, besides itself.
ALLOWED = {
    "parallel": set(),
    "geometry": set(),
    "forest": {"geometry", "parallel"},
    "cad": {"geometry"},
    "front": {"geometry"},
    "mesh": {"geometry", "parallel"},
    "cavities": {"geometry", "parallel", "mesh"},
    "sizing": {"geometry", "parallel", "cad"},
    "partition": {"geometry", "parallel", "mesh"},
    "attribution": {"geometry", "parallel", "mesh", "sizing"},
    "surface": STAGE,
    "layers": {"geometry", "parallel", "mesh"},
    "volume": STAGE,
    "improve": STAGE,
    "io": {"geometry", "parallel", "mesh"},
    "picture": {"geometry", "parallel", "mesh"},
    "imported": {"geometry", "parallel", "mesh", "partition", "io"},
    "page": set(),
    "study": {"parallel", "page"},
    "case": STAGES,
    "domain": STAGES | {"case"},
    "report": STAGES | {"case", "domain", "page", "picture", "study"},
    "pipeline": STAGES | {"case", "domain", "report", "page", "picture", "study", "imported"},
}

# Third-party headers: pattern, folders that may include them, how many files may.
ROOMS = [
    (re.compile(r"mpi\.h$"), {"parallel"}, None),
    (re.compile(r"p[468]est\w*\.h$|sc(_\w+)?\.h$"), {"forest", "tests"}, None),
    (re.compile(r"metis\.h$"), {"partition"}, None),
    (re.compile(r"tetgen\.h$"), {"volume"}, 1),
    (re.compile(r"vtk[A-Z]\w*\.h$|hdf5\.h$"), {"io", "tests"}, None),
    (re.compile(r"png\.h$"), {"picture", "tests"}, None),
    (re.compile(r"yaml-cpp/"), {"case"}, None),
    (re.compile(r"muParser\w*\.h$"), {"sizing"}, 1),
    (re.compile(r"CGAL/"), {"geometry"}, None),
]
OPENCASCADE = re.compile(
    r"(Standard|TopoDS|TopExp|TopTools|TopLoc|TopAbs|BRep\w*|BOPAlgo\w*|Geom\w*|Poly|STEP\w+|IGES\w+|XCAF\w+|XSControl|TDF|TDocStd"
    r"|TCol\w+|ShapeFix|ShapeAnalysis|ShapeUpgrade|BinTools|BndLib|Bnd|GProp|gp|Interface|Quantity|NCollection|Message"
    r"|IMeshTools|Adaptor\w+|ElCLib|ElSLib|GC|GCPnts|Precision|OSD)(_\w+)?\.hxx$")
MPI_NAME = re.compile(r"\bMPI_[A-Z]\w*")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
CONCEPT_FREE = {"utils", "util", "common", "core", "misc", "helpers"}

MOST_PARAMETERS = 6
# Functions whose parameters a library dictates: libsc's sc_log_handler_t.
DICTATED = {("forest/library.cpp", "keep_error"), ("tests/forest/host.cpp", "count_words")}
# Comments, and literals with the brackets and commas in them.
COMMENT_OR_LITERAL = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
# What stands before a list in brackets: a name or the captures of a lambda.
OPENING = re.compile(r"([\w:~]+|\])\s*\(")
# A type and a name, with or without a default; or a type that is none but one.
PARAMETER = re.compile(r"(?:const\s+)?(?!return\b|new\b|sizeof\b|not\b)[\w:]+(?:<.*>)?(?:\s*[&*]+\s*|\s+(?:const\s*[&*]\s*)?)"
                       r"(?!const\b)\w+(?:\[\w*\])?(?:\s*=.*)?$|const\s|.*[&*]$", re.DOTALL)
# Before a name they tell that it is called.
CALLING = {"return", "new", "throw", "else", "do", "co_return", "case"}

# A type that a header defines for a namespace: not indented, as clang-format leaves it, and not of another type
# (`struct Model::Data`). Specialisations (`struct Wire<T>`) are of a template defined elsewhere.
TYPE = re.compile(r"^(?:struct|class|union|enum(?: class| struct)?) (\w+)(?!\w|::|\s*<)[^;{]*\{", re.MULTILINE)

PUBLIC = "include/aeroloom"


def sources(root):
    """The sources of each folder, with its headers for host programs."""
    for folder in [*ALLOWED, "tests", "benchmarks"]:
        for path in sorted([*(root / folder).rglob("*"), *(root / PUBLIC / folder).rglob("*")]):
            if path.suffix in {".cpp", ".hpp"}:
                yield folder, path


def split_list(text, begin):
    """The items between the bracket at `begin` and its twin."""
    items, depth, angles, start = [], 0, 0, begin + 1
    for i in range(begin, len(text)):
        c = text[i]
        if c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
        elif c == "<":
            angles += 1
        elif c == ">" and text[i - 1] != "-":
            angles -= 1
        if depth == 0 or (c == "," and depth == 1 and angles <= 0):
            items.append(text[start:i].strip())
            start = i + 1
        if depth == 0:
            return items
    return []


def long_parameter_lists(text):
    """Line, name and number of parameters of each function that is declared with too many."""
    plain = COMMENT_OR_LITERAL.sub(lambda match: '""' + "\n" * match.group().count("\n"), text)
    for match in OPENING.finditer(plain):
        items = split_list(plain, match.end() - 1)
        if len(items) <= MOST_PARAMETERS or not any(PARAMETER.match(item) for item in items):
            continue
        before = re.search(r"(\S*)\s*$", plain[max(0, match.start() - 200):match.start()]).group(1)
        if match.group(1) != "]" and (before in CALLING or re.search(r"[=(,.?!|+-]$|&&$|<<$", before)):
            continue
        yield plain.count("\n", 0, match.start()) + 1, match.group(1), len(items)


def types_defined(text):
    """Names of the types that a header defines for its namespace, with their lines."""
    plain = COMMENT_OR_LITERAL.sub(lambda match: "\n" * match.group().count("\n"), text)
    for match in TYPE.finditer(plain):
        yield plain.count("\n", 0, match.start()) + 1, match.group(1)


def violations(root):
    found = []
    types = {}
    uses = {pattern: set() for pattern, _, _ in ROOMS}
    for folder, path in sources(root):
        name = path.relative_to(root)
        text = path.read_text()
        for number, function, count in long_parameter_lists(text):
            if (str(name), function) not in DICTATED:
                found.append(f"{name}:{number}: {count} parameters, at most {MOST_PARAMETERS}: group what belongs together")
        for number, type_name in types_defined(text) if path.suffix == ".hpp" else ():
            where = f"{name}:{number}"
            if types.setdefault(type_name, where) != where:
                found.append(f"{where}: another type {type_name} is defined in {types[type_name]}")
        for number, line in enumerate(text.splitlines(), 1):
            where = f"{name}:{number}"
            if folder not in {"parallel", "tests"} and MPI_NAME.search(line):
                found.append(f"{where}: names MPI outside parallel/")
            match = INCLUDE.match(line)
            if not match:
                continue
            header = match.group(1)
            if str(name).startswith(PUBLIC) and line.count('"') and not header.startswith("aeroloom/"):
                found.append(f"{where}: a header for host programs must not include {header}")
            header = header.removeprefix("aeroloom/")
            target = header.split("/")[0]
            if folder in ALLOWED and target in ALLOWED and target != folder and target not in ALLOWED[folder]:
                found.append(f"{where}: {folder}/ must not include {header}")
            for pattern, rooms, _ in ROOMS:
                if pattern.search(header):
                    uses[pattern].add(str(name))
                    if folder not in rooms:
                        found.append(f"{where}: {header} belongs to {', '.join(sorted(rooms))}/")
            if OPENCASCADE.match(header) and folder not in {"cad", "tests", "benchmarks"}:
                found.append(f"{where}: OpenCASCADE ({header}) belongs to cad/")
    for pattern, _, most in ROOMS:
        if most is not None and len(uses[pattern]) > most:
            found.append(f"{pattern.pattern}: included by {len(uses[pattern])} files, at most {most} may")
    for path in root.iterdir():
        if path.is_dir() and path.name in CONCEPT_FREE:
            found.append(f"{path.name}/: a folder is a concept")
    return found


def self_test():
    """Each planted violation must be found, and a clean tree must be clean."""
    planted = {
        "mesh/up.cpp": '#include "surface/front.hpp"\n',
        "surface/sideways.cpp": '#include "volume/volume_mesher.hpp"\n',
        "mesh/mpi.cpp": "#include <mpi.h>\n",
        "io/names_mpi.cpp": "int r = MPI_Comm_rank;\n",
        "volume/one.cpp": "#include <tetgen.h>\n",
        "surface/tetgen.cpp": "#include <tetgen.h>\n",
        "mesh/vtk.cpp": "#include <vtkPoints.h>\n",
        "surface/occ.cpp": "#include <BRep_Tool.hxx>\n",
        "geometry/occ.cpp": "#include <gp_Pnt.hxx>\n",
        "front/mpi.cpp": '#include "mesh/piece.hpp"\n',
        "volume/forest.cpp": "#include <p8est_ghost.h>\n",
        "mesh/sc.cpp": "#include <sc.h>\n",
        "io/yaml.cpp": "#include <yaml-cpp/yaml.h>\n",
        "include/aeroloom/mesh/inner.hpp": '#include "mesh/inner.hpp"\n',
        "include/aeroloom/mesh/up.hpp": '#include "aeroloom/surface/front.hpp"\n',
        "mesh/long.hpp": "void seven(int a, int b, int c, int d, int e,\n           const std::map<int, int>& f, int);\n",
        "mesh/long_constructor.hpp": "class A {\n  A(int a, int b, int c, B d, B& e, B* f, const char* g = \"\");\n};\n",
        "mesh/name.hpp": "template <class T>\nclass Piece final : public Base<T> {};\n",
        "mesh/kind.hpp": "// of a mesh\nenum class Kind : int { none };\n",
        "mesh/long_lambda.cpp": "const auto f = [&](int a, int b, int c, int d, int e, int f, int g) {};\n",
    }
    clean = {
        "geometry/piece.hpp": "struct Piece;\nstruct Piece {\n  enum class Side { left };\n};\nstruct Piece::Kind {};\n",
        "geometry/traits.hpp": "template <>\nstruct Piece<int> {};\nenum class Kind {};\n",
        "geometry/side.hpp": "// struct Piece {\nstruct Side {};\n",
        "mesh/local.cpp": "struct Piece {};\n",
        "mesh/down.cpp": '#include "geometry/vec.hpp"\n',
        "cad/model/occ.cpp": "#include <gp_Pnt.hxx>\n",
        "mesh/six.hpp": "void six(const std::map<int, int>& a, int b, int c, int d, int e, int f);  // of (a, b, c, d, e, f, g)\n",
        "mesh/calls.cpp": 'auto s = fmt::format("{}, {}", a, b, c, d, e, f * g);\nreturn std::tuple(&A::a, a, b, c, d, e, f);\n',
        "forest/library.cpp": "void keep_error(FILE*, const char*, int, int, int, int priority, const char* text) {}\n",
    }
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for file, text in clean.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        assert violations(root) == [], violations(root)
        for file, text in planted.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        (root / "utils").mkdir()
        found = violations(root)
        for file in set(planted) - {"volume/one.cpp"}:
            assert any(v.startswith(file + ":") for v in found), f"missed {file}"
        assert any("at most 1" in v for v in found) and any(v.startswith("utils/") for v in found), found


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "architecture: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
