#!/usr/bin/env python3
"""How the volume stage spreads over ranks, as a Markdown table.

usage: volume_balance.py PROGRAM CASE [RANKS ...] [--page FILE] [-- KEY=VALUE ...]

Runs the case on each number of ranks (default 1 2 3 5 8). CPU seconds are those of tasks, contained children
included, of the stages decompose and volume together; serial is what one rank does alone or all repeat, over the
sum of all ranks; memory is the largest rank's peak in these stages, children included.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from printed_table import PrintedTable, take_page_option

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(program, case, ranks, settings, folder):
    command = [str(ROOT / "scripts/mpirun_local.sh"), str(ranks), program, "run", case, "--set", f"output.directory={folder}"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{ranks} ranks ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads((pathlib.Path(folder) / "report.json").read_text())


def main():
    arguments, settings = sys.argv[1:], []
    if "--" in arguments:
        settings = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    arguments, page = take_page_option(arguments)
    program, case = arguments[:2]
    table = PrintedTable(pathlib.Path(case).stem, (
        "ranks", "zones", "points known / there are", "tetrahedra", "CPU s", "volume: busiest CPU s", "busiest / mean", "serial",
        "memory MiB", "of one rank's", "hash"))
    alone = None
    for ranks in [int(r) for r in arguments[2:]] or [1, 2, 3, 5, 8]:
        with tempfile.TemporaryDirectory() as folder:
            report = run(program, case, ranks, settings, folder)
        stages = {s["name"]: s for s in report["stages"]}
        both = [stages["decompose"], stages["volume"]]
        cpu = sum(s["cpu_seconds_mean"] * ranks for s in both)
        serial = sum(s["serial_seconds"] for s in both)
        memory = max(s["peak_rss_bytes_max"] for s in both) / 2**20
        alone = alone or memory
        volume, zones = stages["volume"], report["volume"]
        table.add(ranks, zones["zones"], f"{zones['overlap']:.2f}", f"{report['mesh']['tetrahedra']:,}", f"{cpu:.1f}",
                  f"{volume['cpu_seconds_max']:.2f}", f"{volume['cpu_seconds_max'] / volume['cpu_seconds_mean']:.3f}",
                  f"{100 * serial / cpu:.1f} %", f"{memory:.0f}", f"{memory / alone:.2f}", report["mesh"]["hash"][:8])
    table.save(page, f"Settings: {' '.join(settings)}" if settings else "")


if __name__ == "__main__":
    main()
