"""The first frame of a motion that starts from an equilibrium shows what the frame of the equilibrium shows: every array, with the same values.

usage: compare_frames.py VTK_FOLDER STATIC_STEP TRANSIENT_STEP
"""
import sys

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

folder, still, moving = sys.argv[1:]


def arrays(step, kind):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(f"{folder}/{step}_{kind}/frame_000000.vtp")
    reader.Update()
    data = reader.GetOutput().GetPointData()
    return {data.GetArrayName(i): data.GetArray(i) for i in range(data.GetNumberOfArrays())}


def values(array):
    return [array.GetComponent(i, c) for i in range(array.GetNumberOfTuples()) for c in range(array.GetNumberOfComponents())]


for kind in ("line", "surface", "bearings"):
    a, b = arrays(still, kind), arrays(moving, kind)
    if not a:
        sys.exit(f"{kind}: no arrays")
    for name, array in a.items():
        if name not in b:
            sys.exit(f"{kind}: {name} is missing in motion")
        x, y = values(array), values(b[name])
        size = max(map(abs, x))
        # single precision
        if len(x) != len(y) or max(abs(p - q) for p, q in zip(x, y)) > 1e-5 * size + 1e-12:
            sys.exit(f"{kind}: {name} differs, of {size} by {max(abs(p - q) for p, q in zip(x, y))}")
        if name in ("force [N]", "moment [N m]", "von_mises [Pa]") and not size > 1:
            sys.exit(f"{kind}: {name} is empty")
