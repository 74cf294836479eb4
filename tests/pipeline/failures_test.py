#!/usr/bin/env python3
"""Bad input ends on all ranks within seconds, with its exit code and a clear message. usage: failures_test.py PROGRAM"""
import pathlib
import sys
import tempfile

from program import COARSE_WING, SOURCE, Run

STEP_HEADER = """ISO-10303-21;
HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;
DATA;
"""


def expect(name, run, code, *words, reports=True):
    """Whether the run ended with `code`, its message contains each word, and its report says the same. A case that
    cannot be read has no report, nor has a run that cannot write (`reports`)."""
    missing = [w for w in words if w not in run.text]
    ok = run.code == code and not missing and run.seconds < 60
    print(f"{'ok  ' if ok else 'FAIL'} {name}: exit {run.code}, {run.seconds:.1f} s")
    if not ok:
        print(f"  expected exit {code}; missing {missing}\n{run.text}")
    if code == 2 or not reports:
        return ok
    if run.report is None:
        print(f"FAIL {name}: no report.json")
        return False
    if run.report["status"] != "failed" or run.report["exit_code"] != code:
        print(f"FAIL {name}: report.json says {run.report['status']}, exit {run.report['exit_code']}")
        return False
    return ok


def file_case(path):
    return f"geometry: {{file: {path}}}\nsizing: {{minimum: 1, maximum: 100}}\n"


def main():
    program = sys.argv[1]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_bad_"))
    corrupt = folder / "corrupt.step"
    corrupt.write_text(STEP_HEADER + "#1=ADVANCED_FACE('',(#2,#3),#4,.T.);\n#2=FACE_BOUND(\n")
    empty = folder / "empty.step"
    empty.write_text("")
    checks = []
    for ranks in (1, 3):
        checks += [
            expect("unknown key", Run(program, COARSE_WING + "sizng: {minimum: 1}\n", ranks), 2, "sizng", "sizing",
                   "case.yaml:5:"),
            expect("size of zero", Run(program, COARSE_WING, ranks, ["sizing.minimum=0"]), 2, "sizing.minimum"),
            expect("missing file", Run(program, file_case(folder / "absent.step"), ranks), 7, "absent.step"),
            expect("corrupt file", Run(program, file_case(corrupt), ranks), 3, "corrupt.step"),
            expect("empty file", Run(program, file_case(empty), ranks), 3, "empty.step"),
            expect("open shell", Run(program, file_case(SOURCE / "tests/data/open_shell.step"), ranks), 3, "open"),
            expect("abort in TetGen", Run(program, COARSE_WING, ranks, fault="zone=aborts"), 5, "SIGABRT"),
        ]
    checks.append(expect("far field cuts the body", Run(program, COARSE_WING, 3, ["farfield.extent=0.4"]), 3,
                         "far field"))
    checks.append(expect("unwritable output", Run(program, COARSE_WING, 2, ["output.directory=/proc/out"]), 7,
                         reports=False))
    return 0 if all(checks) else 1


if __name__ == "__main__":
    sys.exit(main())
