#!/usr/bin/env python3
"""Completion of command lines in bash, without any package beside it. usage: completion_test.py PROGRAM"""
import pathlib
import subprocess
import sys
import tempfile

FILES = ["case.yaml", "other.yml", "mesh.pvtu", "mesh.su2", "wing.step", "notes.txt", "with space.yaml"]
# As readline sets them; words are broken at `=` there, what is replaced begins behind it. One shell answers all: the arguments
# behind the script are pairs of a line and of where its words break. An answer ends with an empty line.
ASK = """source "$1"
shift
while [ $# -gt 0 ]; do
  COMPREPLY=() COMP_LINE="$1" COMP_POINT=${#1} COMP_WORDBREAKS="$2"
  _aeroloom
  for word in "${COMPREPLY[@]}"; do [ -z "$word" ] || printf '%s\\n' "$word"; done
  echo
  shift 2
done
"""
BREAKS = " \t\n=:"


def split_answers(text):
    """Each answer is some lines and an empty one."""
    answers = [set()]
    for line in text.split("\n")[:-1]:
        if line:
            answers[-1].add(line)
        else:
            answers.append(set())
    return answers[:-1]


def main():
    program = sys.argv[1]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_completion_"))
    script = folder.parent / (folder.name + ".bash")
    script.write_text(subprocess.run([program, "completion", "bash"], capture_output=True, text=True, check=True).stdout)
    for name in FILES:
        (folder / name).touch()
    (folder / "out").mkdir()

    wanted = []  # line, where words break, what must be offered, whether nothing else may

    def expect(line, *words, exactly=False, breaks=BREAKS):
        wanted.append((line, breaks, set(words), exactly))

    expect("aeroloom ", "run", "check", "improve", "info", "quality", "convert", "export-cad", "completion", "init", "schema")
    expect("aeroloom ru", "run", exactly=True)
    expect("aeroloom init --geometry wi", "wing.step", "with space.yaml", exactly=True)
    expect("aeroloom -q ch", "check", exactly=True)
    expect("aeroloom --ver", "--version", "--verbose", exactly=True)
    expect("aeroloom run --", "--set", "--resume", "--checkpoints", "--verbose", "--quiet", "--help")
    expect("aeroloom run ", "case.yaml", "other.yml", "with space.yaml", "out", exactly=True)
    expect("aeroloom run -v ca", "case.yaml", exactly=True)
    expect("aeroloom convert ", "mesh.pvtu", "mesh.su2", "out", exactly=True)
    expect("aeroloom convert mesh.pvtu mesh.s", "mesh.su2", exactly=True)
    expect("aeroloom export-cad case.yaml ", "wing.step", "out", exactly=True)
    expect("aeroloom info ", *FILES, "out", exactly=True)
    expect("aeroloom convert mesh.pvtu b --format vtk", "vtkhdf", exactly=True)
    expect("aeroloom convert --format=su", "su2", "su2b", exactly=True)
    expect("aeroloom completion ", "bash", exactly=True)
    expect("aeroloom run case.yaml --set sizing.", "sizing.minimum=", "sizing.growth=")
    expect("aeroloom run case.yaml --set geometry.dom", "geometry.domain=", exactly=True)
    expect("aeroloom run --set geometry.domain=", "auto", "fluid", "body", exactly=True)
    expect("aeroloom run --set sizing.minimum=1 --set output.pictures=t", "true", exactly=True)
    expect("aeroloom run --set patches.my_wing.type=wa", "wall", exactly=True)
    expect("aeroloom run --set geometry.file=wi", "wing.step", "with space.yaml", exactly=True)
    expect("aeroloom run --set sizing.minimum=", exactly=True)
    expect("aeroloom nothing ", exactly=True)
    expect("aeroloom run --set geometry.domain=fl", "geometry.domain=fluid", exactly=True, breaks=" \t\n")

    done = subprocess.run(["bash", "-c", ASK, "bash", script, *(word for line, breaks, *_ in wanted for word in (line, breaks))],
                          capture_output=True, text=True, check=True, cwd=folder)
    assert done.stderr == "", done.stderr
    answers = split_answers(done.stdout)
    assert len(answers) == len(wanted), (len(answers), done.stdout)
    for (line, _, words, exactly), found in zip(wanted, answers):
        assert words == found if exactly else words <= found, f"{line!r}: {sorted(found)}"
        if line == "aeroloom run --":
            assert "--format" not in found, found
        if line.endswith("--set sizing."):
            assert all(key.startswith("sizing.") and key.endswith("=") for key in found), found


if __name__ == "__main__":
    main()
