"""A mesh for Code_Saturne: where its tools are, and its preprocessor."""
import pathlib

from potential_flow import ROOT, run


def add_options(parser):
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/aeroloom")
    parser.add_argument("--tools", type=pathlib.Path, default=pathlib.Path("/usr/lib/code_saturne"))


def preprocess(options, folder):
    """mesh_input of options.mesh, which is a CGNS file or anything that `aeroloom convert` reads."""
    mesh = options.mesh.resolve()
    if mesh.suffix != ".cgns":
        run([options.program.resolve(), "convert", mesh, folder / "mesh.cgns"], folder, "log.convert")
        mesh = folder / "mesh.cgns"
    run([options.tools / "cs_preprocess", "--grp-fac", "section", "--log", "preprocessor.log", "-o", "mesh_input", mesh], folder,
        "log.preprocess")
