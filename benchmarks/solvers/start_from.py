"""A flow on one grid as the start of a run on another: every cell takes the values of the nearest cell there, by centres. OpenFOAM's
`mapFields` interpolates, but had not ended after ten minutes for half a million cells, which take seconds here."""
import numpy
import scipy.spatial

import simple_case
from potential_flow import run

WIDTHS = {"volScalarField": 1, "volVectorField": 3}


def values_of(path, width):
    """The internal field of a binary file, a row a cell."""
    data = path.read_bytes()
    begin = data.index(b"internalField")
    count, begin = next((int(line), at) for line, at in lines_from(data, begin) if line.strip().isdigit())
    begin = data.index(b"(", begin) + 1
    return numpy.frombuffer(data, dtype="<f8", count=count * width, offset=begin).reshape(count, width)


def lines_from(data, begin):
    """Lines as text with the places where they end."""
    while (end := data.find(b"\n", begin)) >= 0:
        yield data[begin:end].decode("latin-1"), end
        begin = end + 1


def centres(folder, time):
    run(["postProcess", "-func", "writeCellCentres", "-time", time], folder, "log.writeCellCentres")
    found = numpy.array(values_of(folder / time / "C", 3))
    for path in (folder / time).glob("C*"):
        path.unlink()
    return found


def start_from(folder, other):
    """Fields in 0/ of `folder`, whose conditions at the border stay, from the last step that `other` has written."""
    last = max((path.name for path in other.iterdir() if path.name.isdigit()), key=int)
    _, nearest = scipy.spatial.cKDTree(centres(other, last)).query(centres(folder, "0"))
    for name, (kind, *_) in simple_case.FIELDS.items():
        width = WIDTHS[kind]
        values = values_of(other / last / name, width)[nearest]
        rows = "\n".join(f"{row[0]:.9g}" if width == 1 else "({:.9g} {:.9g} {:.9g})".format(*row) for row in values)
        path = folder / "0" / name
        text = path.read_text()
        begin = text.index("internalField")
        end = text.index(";", begin) + 1
        kind_of_list = "scalar" if width == 1 else "vector"
        path.write_text(f"{text[:begin]}internalField nonuniform List<{kind_of_list}>\n{len(values)}\n(\n{rows}\n)\n;{text[end:]}")
