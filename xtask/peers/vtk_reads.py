"""Reads files of VTK's unstructured grids, and says what is in each.

    python vtk_reads.py                   prints the version of VTK
    python vtk_reads.py FILE...           prints a line of JSON for each file

A line has the numbers of points and cells, the number of cells of each type, and for every array its type, components, number of numbers, range
and a sum over its bits in which each number counts by its place, modulo 2^64.
"""

import json
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def told(array, type_name=None):
    """What an array has; with a type's name of integers, as those."""
    if array is None:
        return None
    numbers = vtk_to_numpy(array)
    components = array.GetNumberOfComponents()
    numbers = numpy.ascontiguousarray(numbers).reshape(-1)
    if type_name:
        numbers = numbers.astype(type_name)
    with numpy.errstate(over="ignore"):
        if numbers.dtype.kind == "f":
            words = numbers.view("uint32" if numbers.dtype.itemsize == 4 else "uint64").astype("uint64")
        else:
            words = numbers.astype("int64" if numbers.dtype.kind == "i" else "uint64").view("uint64")
        weights = numpy.arange(1, 2 * len(words) + 1, 2, dtype="uint64")
        total = int(numpy.dot(words, weights)) if len(words) else 0
    finite = numbers[numpy.isfinite(numbers)]
    return {
        "type": numbers.dtype.name,
        "components": components,
        "count": len(numbers),
        "range": [float(finite.min()), float(finite.max())] if len(finite) else None,
        "sum": f"{total % 2**64:016x}",
    }


def told_of_file(path):
    """What a file has."""
    reader = vtkXMLUnstructuredGridReader()
    failed = []
    reader.AddObserver("ErrorEvent", lambda *_: failed.append("VTK has an error"))
    reader.SetFileName(path)
    reader.Update()
    if failed:
        return {"error": failed[0]}
    grid = reader.GetOutput()
    cells = grid.GetCells()
    # VTK has its own types for indices; their numbers are what counts.
    arrays = {
        "connectivity": told(cells.GetConnectivityArray(), "int64"),
        "offsets": told(cells.GetOffsetsArray(), "int64"),
    }
    if grid.GetPoints() is not None:
        arrays["positions"] = told(grid.GetPoints().GetData())
    faces = grid.GetPolyhedronFaces() if hasattr(grid, "GetPolyhedronFaces") else None
    if faces is not None and faces.GetNumberOfCells() > 0:
        arrays["face points"] = told(faces.GetConnectivityArray(), "int64")
        arrays["face offsets"] = told(faces.GetOffsetsArray(), "int64")
    for owner, data in (("point", grid.GetPointData()), ("cell", grid.GetCellData())):
        for index in range(data.GetNumberOfArrays()):
            array = data.GetArray(index)
            arrays[f"{owner} array {data.GetArrayName(index)}"] = told(array)
    types = {}
    for cell in range(grid.GetNumberOfCells()):
        number = str(grid.GetCellType(cell))
        types[number] = types.get(number, 0) + 1
    return {"points": grid.GetNumberOfPoints(), "cells": grid.GetNumberOfCells(), "types": types, "arrays": arrays}


if len(sys.argv) == 1:
    print(vtkVersion.GetVTKVersion())
for path in sys.argv[1:]:
    print(json.dumps(told_of_file(path)), flush=True)
