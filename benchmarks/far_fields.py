"""Files whose outer boundary is far field though it is nearer than three times the body, or no box: patches that say so."""
FAR_BOX = {side: {"type": "symmetry" if side == "ymax" else "farfield"} for side in ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")}
FAR_FIELDS = {"gmsh_dlr_f6.brep": FAR_BOX, "gmsh_submarine.stp": {"ymin": {"type": "farfield"}}}
