#!/usr/bin/env python3
"""Completion of command lines in bash, without any package beside it. usage: completion_test.py PROGRAM"""
import pathlib
import subprocess
import sys
import tempfile

FILES = ["case.yaml", "other.yml", "mesh.pvtu", "mesh.su2", "wing.step", "notes.txt", "with space.yaml"]
# As readline sets them; words are broken at `=` there, what is replaced begins behind it.
ASK = """source "$1"
COMP_LINE="$2" COMP_POINT=${#2} COMP_WORDBREAKS="$3"
_aeroloom
printf '%s\\n' "${COMPREPLY[@]}"
"""


def main():
    program = sys.argv[1]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_completion_"))
    script = folder.parent / (folder.name + ".bash")
    script.write_text(subprocess.run([program, "completion", "bash"], capture_output=True, text=True, check=True).stdout)
    for name in FILES:
        (folder / name).touch()
    (folder / "out").mkdir()

    def offered(line, breaks=" \t\n=:"):
        done = subprocess.run(["bash", "-c", ASK, "bash", script, line, breaks], capture_output=True, text=True,
                              check=True, cwd=folder)
        assert done.stderr == "", done.stderr
        return set(done.stdout.split("\n")) - {""}

    def expect(line, *words, exactly=False):
        found = offered(line)
        assert set(words) == found if exactly else set(words) <= found, f"{line!r}: {sorted(found)}"
        return found

    expect("aeroloom ", "run", "check", "improve", "info", "quality", "convert", "export-cad", "completion", "init", "schema")
    expect("aeroloom ru", "run", exactly=True)
    expect("aeroloom init --geometry wi", "wing.step", "with space.yaml", exactly=True)
    expect("aeroloom -q ch", "check", exactly=True)
    expect("aeroloom --ver", "--version", "--verbose", exactly=True)
    expect("aeroloom run --", "--set", "--resume", "--checkpoints", "--verbose", "--quiet", "--help")
    assert "--format" not in offered("aeroloom run --")
    expect("aeroloom run ", "case.yaml", "other.yml", "with space.yaml", "out", exactly=True)
    expect("aeroloom run -v ca", "case.yaml", exactly=True)
    expect("aeroloom convert ", "mesh.pvtu", "mesh.su2", "out", exactly=True)
    expect("aeroloom convert mesh.pvtu mesh.s", "mesh.su2", exactly=True)
    expect("aeroloom export-cad case.yaml ", "wing.step", "out", exactly=True)
    expect("aeroloom info ", *FILES, "out", exactly=True)
    expect("aeroloom convert mesh.pvtu b --format vtk", "vtkhdf", exactly=True)
    expect("aeroloom convert --format=su", "su2", "su2b", exactly=True)
    expect("aeroloom completion ", "bash", exactly=True)
    keys = expect("aeroloom run case.yaml --set sizing.", "sizing.minimum=", "sizing.growth=")
    assert all(key.startswith("sizing.") and key.endswith("=") for key in keys), keys
    expect("aeroloom run case.yaml --set geometry.dom", "geometry.domain=", exactly=True)
    expect("aeroloom run --set geometry.domain=", "auto", "fluid", "body", exactly=True)
    expect("aeroloom run --set sizing.minimum=1 --set output.pictures=t", "true", exactly=True)
    expect("aeroloom run --set patches.my_wing.type=wa", "wall", exactly=True)
    expect("aeroloom run --set geometry.file=wi", "wing.step", "with space.yaml", exactly=True)
    expect("aeroloom run --set sizing.minimum=", exactly=True)
    expect("aeroloom nothing ", exactly=True)
    whole = offered("aeroloom run --set geometry.domain=fl", breaks=" \t\n")
    assert whole == {"geometry.domain=fluid"}, whole


if __name__ == "__main__":
    main()
