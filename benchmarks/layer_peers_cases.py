"""What `layer_peers.py` gives to Gmsh and to snappyHexMesh."""
import re

import numpy

HEADER = "FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n"


def heights(first, growth, constant, count):
    """Of each layer, from the wall on."""
    return [first * growth**max(0, k - constant + 1) for k in range(count)]


def write_gmsh(folder, wall, whole):
    """The boundary as surfaces 1 (wall, turned into the fluid) and 2, and the script that extrudes and fills."""
    lines = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes", str(len(wall.points))]
    lines += [f"{i + 1} {x:.17g} {y:.17g} {z:.17g}" for i, (x, y, z) in enumerate(wall.points)]
    kept = wall.triangles if whole else wall.walls
    is_wall = wall.is_wall if whole else numpy.ones(len(kept), bool)
    lines += ["$EndNodes\n$Elements", str(len(kept))]
    for i, ((a, b, c), inner) in enumerate(zip(kept + 1, is_wall)):
        tag, last = (1, f"{c} {b} {a}") if inner else (2, f"{a} {b} {c}")
        lines.append(f"{i + 1} 2 2 {tag} {tag} {last}")
    (folder / "boundary.msh").write_text("\n".join(lines) + "\n$EndElements\n")
    ones, ends = ",".join(["1"] * len(wall.heights)), ",".join(f"{h:.9g}" for h in numpy.cumsum(wall.heights))
    script = ('Merge "boundary.msh";\nMesh.SaveAll = 1;\n'
              f"made[] = Extrude {{ Surface{{1}}; Layers{{ {{{ones}}}, {{{ends}}} }}; Recombine; }};\n")
    if whole:
        script += "Surface Loop(10) = {made[0]}; Surface Loop(11) = {2}; Volume(100) = {10, 11};\n"
    (folder / "layers.geo").write_text(script)


def write_stl(path, points, triangles):
    with open(path, "w", encoding="ascii") as out:
        out.write("solid wall\n")
        for corners in points[triangles]:
            out.write("facet normal 0 0 0\nouter loop\n")
            out.writelines(f"vertex {x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in corners)
            out.write("endloop\nendfacet\n")
        out.write("endsolid wall\n")


# Layers end one by one from cell to cell; all at once (-1) left the wing of D150 without any.
BUFFER = 0

SNAPPY = """castellatedMesh true;
snap true;
addLayers true;
geometry {{ wall.stl {{ type triSurfaceMesh; name wall; }} }}
castellatedMeshControls
{{
    maxLocalCells 20000000;
    maxGlobalCells 20000000;
    minRefinementCells 0;
    nCellsBetweenLevels 3;
    features ( {{ file "wall.eMesh"; level {level}; }} );
    refinementSurfaces {{ wall {{ level ({level} {level}); patchInfo {{ type wall; }} }} }}
    resolveFeatureAngle 30;
    refinementRegions {{ }}
    locationInMesh ({inside});
    allowFreeStandingZoneFaces true;
}}
snapControls
{{
    nSmoothPatch 3;
    tolerance 2.0;
    nSolveIter 50;
    nRelaxIter 5;
    nFeatureSnapIter 10;
    explicitFeatureSnap true;
    implicitFeatureSnap false;
}}
addLayersControls
{{
    relativeSizes false;
    layers {{ wall {{ nSurfaceLayers {count}; }} }}
    firstLayerThickness {first};
    expansionRatio {growth};
    minThickness {least};
    nGrow 0;
    featureAngle 180;
    slipFeatureAngle 30;
    nRelaxIter 5;
    nSmoothSurfaceNormals 1;
    nSmoothNormals 3;
    nSmoothThickness 10;
    maxFaceThicknessRatio 0.5;
    maxThicknessToMedialRatio 0.3;
    minMedialAxisAngle 90;
    nBufferCellsNoExtrude {buffer};
    nLayerIter 50;
    nRelaxedIter 20;
}}
meshQualityControls
{{
    maxNonOrtho 65;
    maxBoundarySkewness 20;
    maxInternalSkewness 4;
    maxConcave 80;
    minVol 1e-30;
    minArea -1;
    minTetQuality -1e30;
    minTwist 0.02;
    minDeterminant 0.001;
    minFaceWeight 0.05;
    minVolRatio 0.01;
    minTriangleTwist -1;
    nSmoothScale 4;
    errorReduction 0.75;
    relaxed {{ maxNonOrtho 75; minTetQuality -1e30; }}
}}
writeFlags (layerSets layerFields);
mergeTolerance 1e-6;
"""

BLOCK = """vertices ({vertices});
blocks ( hex (0 1 2 3 4 5 6 7) ({cells}) simpleGrading (1 1 1) );
boundary ( farfield {{ type patch; faces ((0 3 2 1) (4 5 6 7) (0 1 5 4) (3 7 6 2) (0 4 7 3) (1 2 6 5)); }} );
"""

CONTROL = """application snappyHexMesh; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep;
writeInterval 1; writeFormat ascii; writePrecision 14;
"""

SCHEMES = """ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }
"""

FEATURES = "wall.stl {{ extractionMethod extractFromSurface; extractFromSurfaceCoeffs {{ includedAngle 150; }} writeObj no; }}\n"


def write_snappy(folder, wall):
    """The box of our domain in cubes that halve to the median edge of our wall, and all dictionaries."""
    for name in ("system", "constant/triSurface"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    write_stl(folder / "constant/triSurface/wall.stl", wall.points, wall.walls)
    low, high = wall.points.min(axis=0), wall.points.max(axis=0)
    level = 0
    while wall.edge * 2**level < (high - low).min() / 16:
        level += 1
    cells = numpy.maximum(1, numpy.rint((high - low) / (wall.edge * 2**level)).astype(int))
    corners = [(i, j, k) for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    ends = numpy.array([low, high])
    vertices = " ".join("(" + " ".join(f"{ends[c][axis]:.12g}" for axis, c in enumerate(corner)) + ")" for corner in corners)
    # Off the faces between cells of any level.
    inside = low + (high - low) * numpy.array([0.0137, 0.0171, 0.0193])
    growth = wall.heights[-1] / wall.heights[-2]
    files = {"controlDict": CONTROL, "fvSchemes": SCHEMES, "fvSolution": "",
             "surfaceFeatureExtractDict": FEATURES.replace("{{", "{").replace("}}", "}"),
             "blockMeshDict": BLOCK.format(vertices=vertices, cells=" ".join(map(str, cells))),
             "snappyHexMeshDict": SNAPPY.format(
                 level=level, buffer=BUFFER, inside=" ".join(f"{x:.9g}" for x in inside), count=len(wall.heights), growth=f"{growth:.6g}",
                 first=f"{wall.heights[0]:.9g}", least=f"{0.1 * wall.heights[0]:.6g}")}
    for name, text in files.items():
        (folder / "system" / name).write_text(HEADER.format(name=name) + text)


def cells_in_set(folder):
    """Numbers of the cells that snappyHexMesh added as layers."""
    path = next(folder.glob("**/sets/addedCells"))
    text = path.read_text().split("(", 1)[1].rsplit(")", 1)[0]
    return numpy.array([int(n) for n in re.findall(r"\d+", text)], int)
