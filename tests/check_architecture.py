#!/usr/bin/env python3
"""Checks the architecture: includes point down, third-party headers stay in their room, no function has more than
six parameters, no two headers define types of one name, no two sources that are compiled as one define a name in
namespaces without a name, host programs are given few headers.

usage: check_architecture.py SOURCE_DIR | check_architecture.py --self-test
"""
import pathlib
import re
import sys
import tempfile

# What each folder may include, besides itself; lowest first.
BASE = {"geometry", "parallel", "mesh", "cad", "sizing"}
ALLOWED = {
    "parallel": set(),
    "geometry": set(),
    "mesh": {"geometry", "parallel"},
    "cad": {"geometry"},
    "sizing": {"cad", "geometry", "mesh", "parallel"},
    "surface": BASE,
    "layers": {"geometry", "parallel", "mesh"},
    "volume": BASE,
    "improve": BASE,
    "io": {"geometry", "parallel", "mesh"},
    "pipeline": BASE | {"surface", "layers", "volume", "improve", "io"},
}
# Sub-folders that are libraries, lowest first: each may include those before it. Files of the folder itself are "."; a
# sub-folder may include one of them only where that file needs no sub-folder: options, reports, errors, entries.
ORDER = {
    "mesh": ["data", "exchange", "quality", "checks", "transfer", "."],
    "sizing": ["field", "features", "sources", "choice", "lifting", "."],
    "surface": ["front", "curves", "rows", "remesh", "charts", "division", "cusps", "."],
    "volume": ["lattice", "core", "zones", "filling", "."],
    "improve": ["attribution", "tets", "limits", "operations", "pieces", "borders", "."],
    "io": [".", "import"],
    "pipeline": ["case", "domain", "report/page", "report/picture", "study", "report", ".", "commands"],
}
# Sub-folders that may include less than what stands before them: other folders, sub-folders of their own.
RESTRICTED = {
    "surface/front": {"geometry"},
    "surface/division": BASE | {"surface/remesh", "surface/charts", "surface/curves"},
    "improve/attribution": {"geometry", "parallel", "mesh", "sizing"},
    "improve/limits": {"geometry", "mesh", "sizing", "improve/tets"},
    "improve/tets": {"geometry", "mesh"},
    "pipeline/case": ALLOWED["pipeline"],
    "pipeline/report/page": set(),
    "pipeline/report/picture": {"geometry", "parallel", "mesh"},
    "pipeline/study": {"geometry", "parallel", "pipeline/report/page"},
}
# One folder each: nobody outside of it includes what serves it alone.
INNER = ["surface/front", "surface/curves", "surface/rows", "surface/remesh", "surface/charts", "surface/cusps", "volume/lattice", "volume/core",
         "volume/zones", "volume/filling", "improve/tets", "improve/limits", "improve/operations",
         "improve/pieces", "improve/borders"]
# What tells the versions of libraries, for the report.
VERSIONS = re.compile(r"_version\.hpp$")

# Third-party headers: pattern, folders that may include them, how many files may.
ROOMS = [
    (re.compile(r"mpi\.h$"), {"parallel"}, None),
    (re.compile(r"p[468]est\w*\.h$|sc(_\w+)?\.h$"), {"volume/lattice", "tests"}, None),
    (re.compile(r"metis\.h$"), {"surface/division"}, None),
    (re.compile(r"tetgen\.h$"), {"volume"}, 1),
    (re.compile(r"vtk[A-Z]\w*\.h$|hdf5\.h$"), {"io", "tests"}, None),
    (re.compile(r"png\.h$"), {"pipeline/report/picture", "tests"}, None),
    (re.compile(r"yaml-cpp/"), {"pipeline/case"}, None),
    (re.compile(r"muParser\w*\.h$"), {"sizing/sources"}, 1),
    (re.compile(r"Eigen/"), {"surface/charts"}, None),
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
# Headers of host programs in all: each has to stay as it is for them. One more takes the place of another.
MOST_PUBLIC_HEADERS = 75
# Functions whose parameters a library dictates: libsc's sc_log_handler_t, HDF5's H5L_elink_traverse_t.
DICTATED = {("volume/lattice/p4est_library.cpp", "keep_error"), ("tests/volume/lattice/host.cpp", "count_words"),
            ("io/hdf5/sandboxed_reading.cpp", "refuse_link")}
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

# A library of a folder's CMakeLists, with what is given to it.
LIBRARY = re.compile(r"aeroloom_library\((\S+)([^)]*)\)")
KEYWORDS = {"SOURCES", "ALONE", "HEADERS", "PUBLIC", "PRIVATE"}


def sources(root):
    """The sources of each folder."""
    for folder in [*ALLOWED, "tests", "benchmarks"]:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".cpp", ".hpp"}:
                yield folder, path


def libraries(root):
    """Each library of the source folders: its folder and what stands after each keyword in its CMakeLists."""
    for folder in ALLOWED:
        for path in sorted((root / folder).rglob("CMakeLists.txt")):
            for match in LIBRARY.finditer(path.read_text()):
                given, keyword = {key: [] for key in KEYWORDS}, None
                for word in match.group(2).split():
                    keyword = word if word in KEYWORDS else keyword
                    if word not in KEYWORDS and keyword:
                        given[keyword].append(word)
                yield match.group(1), given


def public_headers(root):
    """Headers of host programs, as paths from the root."""
    return {f"{folder}/{header}" for folder, given in libraries(root) for header in given["HEADERS"]}


def place(name):
    """Folder and sub-folder of a file or header: ("mesh", "data"), ("mesh", ".")."""
    folder, _, rest = name.partition("/")
    inner = [sub for sub in ORDER.get(folder, []) if rest.startswith(sub + "/")]
    return folder, max(inner, key=len, default=".")


def includes(root, name):
    """Headers of the project that a file includes."""
    found = []
    for line in (root / name).read_text().splitlines():
        match = INCLUDE.match(line)
        if match and match.group(1).split("/")[0] in ALLOWED:
            found.append(match.group(1))
    return found


def needs_sub_folder(root, header, seen):
    """Whether a header of a folder itself includes, through others of the folder, one of its sub-folders."""
    folder, sub = place(header)
    if sub != ".":
        return True
    seen.add(header)
    for other in includes(root, header) if (root / header).exists() else []:
        if other.split("/")[0] == folder and other not in seen and needs_sub_folder(root, other, seen):
            return True
    return False


def fault_of_include(root, name, header):
    """What is wrong with an include of a source, or None."""
    folder, sub = place(name)
    target, target_sub = place(header)
    if target not in ALLOWED:
        return None
    here, there = f"{folder}/{sub}", f"{target}/{target_sub}"
    if folder != target and folder in ALLOWED:
        inner = [room for room in INNER if header.startswith(room + "/")]
        if inner and not VERSIONS.search(header):
            return f"only {target}/ includes {inner[0]}/"
        allowed = RESTRICTED.get(here, ALLOWED[folder])
        return None if target in allowed and target in ALLOWED[folder] else f"{here.removesuffix('/.')}/ must not include {header}"
    if folder != target or sub == target_sub or folder not in ORDER:
        return None
    if target_sub == "." and not needs_sub_folder(root, header, set()):
        return None
    order = ORDER[folder]
    if order.index(target_sub) > order.index(sub) or (here in RESTRICTED and there not in RESTRICTED[here]):
        return f"{here.removesuffix('/.')}/ must not include {header}"
    return None


# What a namespace without a name holds, as clang-format leaves it.
NAMELESS = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.MULTILINE | re.DOTALL)
# Names that it defines: types, aliases, functions, constants; not indented but in it.
DEFINED = re.compile(
    r"^(?:struct|class|enum class|enum) (\w+)[^;{]*\{|^using (\w+) =|^(?:inline |static )?(?:constexpr|const) [^;(]*?(\w+)(?:\[\w*\])? (?:=|\{)"
    r"|^(?:\[\[\w+\]\] )?(?:\w[\w:<>,&*\[\] ]* [&*]?)(\w+)\([^;]*\{$", re.MULTILINE)


def equal_names(root):
    """Names that two sources of one library define in namespaces without a name: several sources are compiled as one
    unit. Aliases of one text do no harm."""
    for folder, given in libraries(root):
        defined = {}
        for source in given["SOURCES"]:
            path = root / folder / source
            where = f"{folder}/{source}"
            for block in NAMELESS.findall(path.read_text() if path.exists() else ""):
                plain = COMMENT_OR_LITERAL.sub('""', block)
                for match in DEFINED.finditer(plain):
                    name = next(filter(None, match.groups()))
                    alias = re.match(r"using [^;]*;", plain[match.start():])
                    other, text = defined.setdefault(name, (where, alias and alias.group()))
                    if other != where and not (alias and alias.group() == text):
                        yield where, name, other


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
    host_headers = public_headers(root)
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
        public = str(name) in host_headers
        for number, line in enumerate(text.splitlines(), 1):
            where = f"{name}:{number}"
            if folder not in {"parallel", "tests"} and MPI_NAME.search(line):
                found.append(f"{where}: names MPI outside parallel/")
            match = INCLUDE.match(line)
            if not match:
                continue
            header = match.group(1)
            if public and header.split("/")[0] in ALLOWED and header not in host_headers:
                found.append(f"{where}: a header for host programs must not include {header}")
            fault = fault_of_include(root, str(name), header) if folder in ALLOWED else None
            if fault:
                found.append(f"{where}: {fault}")
            for pattern, rooms, _ in ROOMS:
                if pattern.search(header):
                    uses[pattern].add(str(name))
                    if not any(room == folder or str(name).startswith(room + "/") for room in rooms):
                        found.append(f"{where}: {header} belongs to {', '.join(sorted(rooms))}/")
            if OPENCASCADE.match(header) and folder not in {"cad", "tests", "benchmarks"}:
                found.append(f"{where}: OpenCASCADE ({header}) belongs to cad/")
    for pattern, _, most in ROOMS:
        if most is not None and len(uses[pattern]) > most:
            found.append(f"{pattern.pattern}: included by {len(uses[pattern])} files, at most {most} may")
    for where, defined, other in equal_names(root):
        found.append(f"{where}: {other} has a {defined} in a namespace without a name too: one library")
    if len(host_headers) > MOST_PUBLIC_HEADERS:
        found.append(f"HEADERS: {len(host_headers)} for host programs, at most {MOST_PUBLIC_HEADERS}")
    for path in root.iterdir():
        if path.is_dir() and path.name in CONCEPT_FREE:
            found.append(f"{path.name}/: a folder is a concept")
    return found


def self_test():
    """Each planted violation must be found, and a clean tree must be clean."""
    planted = {
        "mesh/data/up.cpp": '#include "surface/options.hpp"\n',
        "surface/sideways.cpp": '#include "volume/volume_mesher.hpp"\n',
        "mesh/data/sub_up.cpp": '#include "mesh/checks/validity.hpp"\n',
        "surface/curves/to_driver.cpp": '#include "surface/driver.hpp"\n',
        "volume/inner.cpp": '#include "volume/lattice/tree.hpp"\n#include "surface/charts/chart.hpp"\n',
        "pipeline/not_its_own.cpp": '#include "surface/charts/chart.hpp"\n',
        "pipeline/report/page/mesh.cpp": '#include "mesh/data/piece.hpp"\n',
        "pipeline/case/run.cpp": '#include "pipeline/commands/run.hpp"\n',
        "mesh/mpi.cpp": "#include <mpi.h>\n",
        "io/names_mpi.cpp": "int r = MPI_Comm_rank;\n",
        "volume/filling/one.cpp": "#include <tetgen.h>\n",
        "surface/tetgen.cpp": "#include <tetgen.h>\n",
        "mesh/vtk.cpp": "#include <vtkPoints.h>\n",
        "surface/occ.cpp": "#include <BRep_Tool.hxx>\n",
        "geometry/occ.cpp": "#include <gp_Pnt.hxx>\n",
        "surface/front/mpi.cpp": '#include "mesh/data/piece.hpp"\n',
        "volume/zones/forest.cpp": "#include <p8est_ghost.h>\n",
        "mesh/sc.cpp": "#include <sc.h>\n",
        "io/yaml.cpp": "#include <yaml-cpp/yaml.h>\n",
        "surface/charts.cpp": "#include <Eigen/Sparse>\n",
        "mesh/data/public.hpp": '#include "mesh/data/inner.hpp"\n',
        "mesh/data/second.cpp": "namespace {\n\ndouble area_of(int a) {\n  return a;\n}\n\n}  // namespace\n",
        "mesh/data/alias.cpp": "namespace {\n\nusing Place = Vec2;\n\n}  // namespace\n",
        "mesh/long.hpp": "void seven(int a, int b, int c, int d, int e,\n           const std::map<int, int>& f, int);\n",
        "mesh/long_constructor.hpp": "class A {\n  A(int a, int b, int c, B d, B& e, B* f, const char* g = \"\");\n};\n",
        "mesh/name.hpp": "template <class T>\nclass Piece final : public Base<T> {};\n",
        "mesh/kind.hpp": "// of a mesh\nenum class Kind : int { none };\n",
        "mesh/long_lambda.cpp": "const auto f = [&](int a, int b, int c, int d, int e, int f, int g) {};\n",
    }
    lists = {"mesh/CMakeLists.txt": "aeroloom_library(mesh/data\n  SOURCES first.cpp second.cpp third.cpp alias.cpp\n  HEADERS public.hpp)\n"
                                    "aeroloom_library(mesh/checks\n  SOURCES other_library.cpp)\n",
             "volume/CMakeLists.txt": "aeroloom_library(volume\n  HEADERS "
                                      + " ".join(f"{i}.hpp" for i in range(1, MOST_PUBLIC_HEADERS)) + ")\n"}
    one_more = "aeroloom_library(layers\n  HEADERS layers.hpp)\n"
    clean = {
        "geometry/piece.hpp": "struct Piece;\nstruct Piece {\n  enum class Side { left };\n};\nstruct Piece::Kind {};\n",
        "geometry/traits.hpp": "template <>\nstruct Piece<int> {};\nenum class Kind {};\n",
        "geometry/side.hpp": "// struct Piece {\nstruct Side {};\n",
        "mesh/local.cpp": "struct Piece {};\n",
        "mesh/down.cpp": '#include "geometry/vec.hpp"\n#include "mesh/data/piece.hpp"\n',
        "mesh/data/first.cpp": "namespace {\n\nusing Place = Vec3;\n\ndouble area_of(double a) {\n  return a;\n}\n\n}  // namespace\n",
        "mesh/data/third.cpp": "namespace {\n\nusing Place = Vec3;\n\n}  // namespace\n",
        "mesh/checks/other_library.cpp": "namespace {\n\ndouble area_of(int a) {\n  return a;\n}\n\n}  // namespace\n",
        "surface/options.hpp": '#include "mesh/data/piece.hpp"\n',
        "surface/driver.hpp": '#include "surface/curves/curves.hpp"\n',
        "surface/curves/options.cpp": '#include "surface/options.hpp"\n',
        "pipeline/report/report.cpp": '#include "pipeline/report/page/svg.hpp"\n#include "volume/lattice/p4est_version.hpp"\n',
        "cad/model/occ.cpp": "#include <gp_Pnt.hxx>\n",
        "mesh/six.hpp": "void six(const std::map<int, int>& a, int b, int c, int d, int e, int f);  // of (a, b, c, d, e, f, g)\n",
        "mesh/calls.cpp": 'auto s = fmt::format("{}, {}", a, b, c, d, e, f * g);\nreturn std::tuple(&A::a, a, b, c, d, e, f);\n',
        "volume/lattice/p4est_library.cpp": "void keep_error(FILE*, const char*, int, int, int, int priority, const char* text) {}\n",
    }
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for file, text in (lists | clean).items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        assert violations(root) == [], violations(root)
        for file, text in planted.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        (root / "layers").mkdir()
        (root / "layers/CMakeLists.txt").write_text(one_more)
        (root / "utils").mkdir()
        found = violations(root)
        for file in set(planted) - {"volume/filling/one.cpp"}:
            assert any(v.startswith(file + ":") for v in found), f"missed {file}"
        assert any("at most 1" in v for v in found) and any(v.startswith("utils/") for v in found), found
        assert any(v.startswith("HEADERS:") for v in found), found


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "architecture: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
