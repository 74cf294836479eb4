"""Runs of surface_benchmark for the scripts beside it."""
import json
import math
import pathlib
import re
import statistics
import subprocess

from far_fields import FAR_FIELDS

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks" / "results"
AIRCRAFT = ROOT.parent / "shared" / "geometry" / "aircraft"
FILES = [ROOT / "configs/geometry/sphere.brep"] + [AIRCRAFT / name for name in (
    "gmsh_dlr_f6.brep", "tigl_D150_fused_aircraft.brep", "su2_oneram6.igs", "gmsh_wing_fuselage.step", "gmsh_submarine.stp",
    "dealii_wing.igs", "pyrefine_cev_capsule.igs")]


def run(program, case, *arguments, ranks=1):
    """The figures of the RESULT line as text, by name; nothing where the run fails."""
    command = [ROOT / "scripts/mpirun_local.sh", ranks, program, case, *arguments]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, cwd=ROOT, check=False)
    return dict(re.findall(r"(\w+)=(\S+)", done.stdout)) if done.returncode == 0 else {}


def run_with_details(program, case, folder, *arguments, ranks=1):
    """As run(), and what --details writes."""
    path = pathlib.Path(folder).resolve() / "details.json"
    figures = run(program, case, *arguments, "--details", path, ranks=ranks)
    return figures, json.loads(path.read_text()) if figures else None


def write_case(file, folder, piece_triangles):
    """A case of this CAD file with sizes from the model."""
    case = pathlib.Path(folder).resolve() / f"{file.stem}.yaml"
    patches = FAR_FIELDS.get(file.name, {})
    case.write_text(f"geometry: {{file: {file}}}\nsurface: {{piece_triangles: {piece_triangles}}}\npatches: {json.dumps(patches)}\n")
    return case


def t_quantile(probability, freedom):
    """Of Student's distribution, by Fisher's expansion about the normal one (Abramowitz and Stegun, 26.7.5): within
    0.5 % from five degrees of freedom on."""
    z = statistics.NormalDist().inv_cdf(probability)
    terms = (z, (z**3 + z) / 4, (5 * z**5 + 16 * z**3 + 3 * z) / 96, (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384,
             (79 * z**9 + 776 * z**7 + 1482 * z**5 - 1920 * z**3 - 945 * z) / 92160)
    return math.fsum(term / freedom**i for i, term in enumerate(terms))
