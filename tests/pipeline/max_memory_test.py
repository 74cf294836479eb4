#!/usr/bin/env python3
"""--max-memory: what does not fit ends on all ranks with code 8 and a message; what fits gives the same mesh.
usage: max_memory_test.py PROGRAM"""
import json
import pathlib
import subprocess
import sys
import tempfile

from program import SOURCE

# Large enough for what does not fit to be the mesh, not the program.
CASE = """
geometry: {builtin: transport}
farfield: {shape: box, extent: 3}
sizing: {minimum: 0.3, maximum: 12, surface_maximum: 2.4, curvature_angle: 20, growth: 1.5}
"""


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_memory_"))
    (folder / "case.yaml").write_text(CASE)

    def run(ranks, *line):
        done = subprocess.run([SOURCE / "scripts" / "mpirun_local.sh", str(ranks), program, *line], cwd=folder,
                              capture_output=True, text=True, timeout=200)
        return done.returncode, done.stdout + done.stderr

    def report():
        return json.loads((folder / "out" / "report.json").read_text())

    def expect(code, words, ranks, *line):
        found, text = run(ranks, *line)
        assert found == code and all(word in text for word in words), f"{ranks} rank(s), {line}: {found}\n{text}"
        return text

    for size in ("8X", "0G", "101%", "G", "-1G", "12", "1e30G"):
        expect(2, ["is no amount of memory"], 1, "run", "case.yaml", f"--max-memory={size}")

    expect(0, ["hash"], 2, "run", "case.yaml")
    free = report()["mesh"]["hash"]
    expect(0, [free], 2, "run", "case.yaml", "--max-memory", "4G")
    # The tetrahedra alone would fit.
    expect(8, ["tetrahedra and", "cells of layers are predicted", "would fit"], 1, "run", "case.yaml", "--set", "layers.first=1e-3",
           "--max-memory", "180M")
    for ranks in (1, 2):
        # Known to be too much once sizes are known.
        expect(8, ["stage sizing failed", "are predicted", "would fit", "--max-memory"], ranks, "run", "case.yaml",
               "--set", "sizing.minimum=0.1", "--set", "sizing.surface_maximum=0.14",
               "--max-memory", f"{150 * ranks}M")
        assert (report()["status"], report()["exit_code"]) == ("failed", 8)
        # Out of memory on the way: in a sandboxed run, and in the ranks.
        text = expect(8, ["stage geometry failed: out of memory", "--max-memory"], ranks, "run", "case.yaml",
                      "--max-memory", f"{45 * ranks}M")
        assert text.count("error") == 1, text
        expect(8, ["out of memory", "--max-memory"], ranks, "convert", "out/mesh.pvtu", "big.cgns", "--max-memory",
               f"{50 * ranks}M")
        assert not (folder / "big.cgns").exists()
        expect(0, ["wrote"], ranks, "convert", "out/mesh.pvtu", "mesh.cgns", "--max-memory", "60%")
        expect(8, ["out of memory", "1 rank(s)" if ranks == 1 else "2 rank(s)"], ranks, "improve", "out/mesh.pvtu",
               "--set", "output.directory=better", "--max-memory", f"{50 * ranks}M")


if __name__ == "__main__":
    main()
