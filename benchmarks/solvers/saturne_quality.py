#!/usr/bin/env python3
"""What Code_Saturne says of a mesh: its preprocessor reads the CGNS file, its solver judges the cells.

usage: saturne_quality.py MESH FOLDER [--program AEROLOOM] [--tools DIR] [--page FILE]

MESH is anything that `aeroloom convert` reads, a CGNS file included. Needs Debian's package code-saturne. Ends with a line RESULT; the
exit code says whether all volumes are positive, no cell fails the criterion of orthogonality and the coherency check was passed.
"""
import argparse
import pathlib
import re
import sys

import saturne_mesh
from potential_flow import ROOT, run

sys.path.append(str(ROOT / "benchmarks"))
from printed_table import PrintedTable, add_page_option  # noqa: E402


def range_of(log, title):
    """Least and greatest value of a histogram of the log."""
    text = log.split(f"Histogram of {title}", 1)[1].split("Histogram of", 1)[0]
    return [float(re.search(rf"{word} value = +(\S+)", text).group(1)) for word in ("minimum", "maximum")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    saturne_mesh.add_options(parser)
    add_page_option(parser)
    options = parser.parse_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    saturne_mesh.preprocess(options, folder)
    run([options.tools / "cs_solver", "--quality"], folder, "log.quality")
    log = (folder / "run_solver.log").read_text(errors="replace")
    cells = int(re.search(r"Number of cells: +(\d+)", log).group(1))
    volumes = [float(re.search(rf"{word} += +(\S+)", log).group(1)) for word in (
        "Minimum control volume", "Maximum control volume", "Total volume for the domain")]
    criteria = re.findall(r"Criterion \d: (.+):\n +Number of bad cells detected: (\d+)", log)
    table = PrintedTable("Bad cells", ("criterion", "bad cells", "share"))
    for name, count in criteria:
        table.add(name, f"{int(count):,}", f"{100 * int(count) / cells:.2f} %")
    table.save(options.page)
    print()
    table = PrintedTable("Ranges", ("quantity", "least", "most"))
    for title in ("the interior faces non-orthogonality coefficient", "the boundary faces non-orthogonality coefficient",
                  "the interior faces warping", "the interior faces weighting coefficient",
                  "the cells off-centering coefficient", "the cellwise warping error"):
        low, high = range_of(log, title)
        table.add(title.removeprefix("the "), f"{low:.4g}", f"{high:.4g}")
    table.save(options.page)
    bad = dict(criteria)
    coherent = "End of coherency check" in log
    print(f"RESULT cells={cells} least_volume={volumes[0]:.6g} most_volume={volumes[1]:.6g} volume={volumes[2]:.8g} "
          + " ".join(f"bad_{name.lower().replace(' ', '_').replace('-', '_')}={count}" for name, count in criteria)
          + f" coherent={int(coherent)}")
    sys.exit(0 if volumes[0] > 0 and int(bad["Orthogonality"]) == 0 and coherent else 1)


if __name__ == "__main__":
    main()
