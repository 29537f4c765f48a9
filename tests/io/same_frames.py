"""Frames of several folders hold the same points, cells, names and numbers, to the last bit, as VTK's own reader sees them.

usage: same_frames.py FOLDER FOLDER ...
"""
import pathlib
import sys

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def numbers(array):
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def texts(array):
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def content(file):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    data = reader.GetOutput()
    found = {"points": numbers(data.GetPoints().GetData())}
    for kind, cells in ("vertices", data.GetVerts()), ("lines", data.GetLines()), ("polygons", data.GetPolys()):
        found[kind] = numbers(cells.GetConnectivityArray()) + numbers(cells.GetOffsetsArray())
    for kind, fields in ("point", data.GetPointData()), ("cell", data.GetCellData()), ("field", data.GetFieldData()):
        for i in range(fields.GetNumberOfArrays()):
            array = fields.GetAbstractArray(i)
            found[kind, array.GetName()] = numbers(array) if fields.GetArray(i) else texts(array)
    return found


first, *others = map(pathlib.Path, sys.argv[1:])
files = sorted(f.relative_to(first) for f in first.rglob("*.vtp"))
if not files:
    sys.exit(f"same_frames.py: no frames in {first}")
for file in files:
    expected = content(first / file)
    if len(expected["points"]) == 0 or len(expected) < 6:
        sys.exit(f"same_frames.py: {file} is empty")
    for other in others:
        if content(other / file) != expected:
            sys.exit(f"same_frames.py: {other / file} differs from {first / file}")
