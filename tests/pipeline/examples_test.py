#!/usr/bin/env python3
"""Every example of the help runs as it stands. usage: examples_test.py PROGRAM"""
import re
import shutil
import sys

from program import COARSE_DUCT, NO_PICTURES
from shell import Shell


def commands_of(shell):
    code, text, _ = shell.run("--help")
    assert code == 0
    return re.findall(r"^  ([a-z-]+) {2,}\S", text.split("\nCommands:")[1].split("Examples:")[0], re.M)


def check_examples(shell):
    """Every example in every help runs as it stands."""
    (shell.folder / "case.yaml").write_text(COARSE_DUCT.replace("2000", "500") + NO_PICTURES)
    (shell.folder / "account.txt").write_text("#SBATCH --account=wing\n")
    commands = commands_of(shell)
    assert {"run", "check", "info", "improve", "quality", "convert", "export-cad", "completion", "init", "schema"} <= set(commands)
    ran = set()
    for command in dict.fromkeys(["", "run", "export-cad", "convert", *commands]):
        code, text, _ = shell.run(f"{command} --help")
        assert code == 0 and "Exit codes:" in text, text
        examples = re.findall(r"^  ((?:mpirun -n \d+ )?aeroloom .*)$", text, re.M)
        assert examples, f"{command}: no examples"
        # The case first, for what others use; mesh.meshb is another program's mesh.
        for example in sorted(examples, key=lambda line: "case.yaml" not in line):
            assert len(example) <= 100, example
            if example in ran:
                continue
            ran.add(example)
            for wanted, source in (("mesh.meshb", "out/mesh.pvtu"), ("out/mesh.pvtu", None), ("wing.step", None)):
                if wanted in example and not (shell.folder / wanted).exists():
                    make = {"mesh.meshb": "aeroloom convert out/mesh.pvtu mesh.meshb",
                            "out/mesh.pvtu": "aeroloom run case.yaml",
                            "wing.step": "aeroloom export-cad case.yaml wing.step"}[wanted]
                    if make != example and not example.startswith("aeroloom export-cad"):
                        assert shell.type(make).returncode == 0, make
            for study in re.findall(r"(?:before|after)/out", example):
                shutil.copytree(shell.folder / "out", shell.folder / study)
            # What writes a case must not find one; a study's runs are repeated for the sake of their medians alone.
            line = f"mkdir new && cd new && {example}" if " init case" in example else example
            if " scaling case.yaml" in example and "--repeats" not in example:
                line += " --repeats 1"
            done = shell.type(line)
            assert done.returncode == (6 if "--gate" in example and done.returncode == 6 else 0), \
                f"{example}: exit {done.returncode}\n{done.stdout}{done.stderr}"
    assert len(ran) >= 15, ran


if __name__ == "__main__":
    check_examples(Shell(sys.argv[1]))
