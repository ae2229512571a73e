"""Draws one mesh with one volume mapper of VTK, off screen.

    python vtk_mappers.py                 prints the version of VTK
    python vtk_mappers.py JOB.json        draws what the file says

A job holds the mesh's file, the name of its scalar, camera, size, transfer function, the mapper and where the pictures go: two files of
32-bit floats in the order of this machine, R, G, B times opacity and opacity, upper row first, of the first frame and of the second. VTK's
frame buffer has 8 bits a channel.
"""

import json
import math
import sys

from vtkmodules.vtkCommonCore import vtkFloatArray, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonTransforms import vtkMatrixToHomogeneousTransform
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkVolumeProperty
from vtkmodules.vtkRenderingVolume import (
    vtkProjectedTetrahedraMapper,
    vtkUnstructuredGridPartialPreIntegration,
    vtkUnstructuredGridVolumeRayCastMapper,
)

# These put what draws behind the names above.
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401

# Two points of a transfer function at one scalar are a step; VTK gets the second one this share of the range further on.
STEP = 1e-6
# The near plane stands no nearer than this share of the far one's distance, where the eye is inside the mesh.
NEAREST = 1e-4
# An odd number: the window of an aligned picture is so many times as wide and high, and the picture its middle.
MARGIN = 5


def without_steps(points, nudge):
    """Points of a function of the scalar, none at the same one."""
    apart = []
    for scalar, *values in points:
        if apart and scalar <= apart[-1][0]:
            # Of three or more at one scalar the last counts; VTK would take them in any order.
            scalar = apart[-1][0] + nudge if apart[-1][0] + nudge > apart[-1][0] else math.nextafter(apart[-1][0], math.inf)
        apart.append([scalar, *values])
    return apart


def value_at(points, scalar):
    """The values of a piecewise linear function, constant beyond its ends."""
    if scalar <= points[0][0]:
        return points[0][1:]
    for low, high in zip(points, points[1:]):
        if scalar <= high[0]:
            share = (scalar - low[0]) / (high[0] - low[0])
            return [a + share * (b - a) for a, b in zip(low[1:], high[1:])]
    return points[-1][1:]


def transfer(job, low, high):
    """VTK's functions, and what its colors are to be multiplied by.

    Projected tetrahedra and the ray integrators take opacity over unit distance as the extinction, as it is: the largest extinction gets
    opacity 1, and its inverse is the unit distance.
    """
    nudge = STEP * max(high - low, abs(low) * 1e-9)
    color = without_steps(job["color"], nudge)
    extinction = without_steps(job["extinction"], nudge)
    if job["merged"]:
        scalars = sorted({low, high} | {point[0] for point in color} | {point[0] for point in extinction})
        color = [[s, *value_at(color, s)] for s in scalars]
        extinction = [[s, *value_at(extinction, s)] for s in scalars]
    largest = max(point[1] for point in extinction)
    brightest = max(1.0, max(max(point[1:]) for point in color))
    colors = vtkColorTransferFunction()
    for s, r, g, b in color:
        colors.AddRGBPoint(s, r / brightest, g / brightest, b / brightest)
    opacities = vtkPiecewiseFunction()
    for s, rho in extinction:
        opacities.AddPoint(s, rho / largest if largest > 0.0 else 0.0)
    volume_property = vtkVolumeProperty()
    volume_property.SetColor(colors)
    volume_property.SetScalarOpacity(opacities)
    volume_property.SetScalarOpacityUnitDistance(1.0 / largest if largest > 0.0 else 1.0)
    volume_property.ShadeOff()
    volume_property.SetInterpolationTypeToLinear()
    return volume_property, brightest


def place(camera, job, mesh):
    """Puts the camera where the job has it, with near and far plane close around the mesh."""
    wanted = job["camera"]
    eye, target = wanted["eye"], wanted["target"]
    camera.SetPosition(*eye)
    camera.SetFocalPoint(*target)
    camera.SetViewUp(*wanted["up"])
    if wanted["projection"] == "perspective":
        slope = margin(job) * math.tan(math.radians(wanted["fov_y"]) / 2.0)
        camera.SetViewAngle(2.0 * math.degrees(math.atan(slope)))
    else:
        camera.ParallelProjectionOn()
        camera.SetParallelScale(margin(job) * wanted["height"] / 2.0)
    forward = [t - e for t, e in zip(target, eye)]
    length = math.sqrt(sum(f * f for f in forward))
    points = (mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints()))
    depths = [sum(f * (p - e) for f, p, e in zip(forward, point, eye)) / length for point in points]
    depths = [depth for depth in depths if math.isfinite(depth)]
    far = max(depths)
    room = 0.01 * (far - min(depths))
    far = far + room if far + room > 0.0 else 1.0
    camera.SetClippingRange(max(min(depths) - room, NEAREST * far), far)
    if job["aligned"]:
        align(camera, [margin(job) * pixels for pixels in job["size"]])


def margin(job):
    """How many times the picture the window is, in width and height."""
    return MARGIN if job["aligned"] else 1


def align(camera, size):
    """Undoes where the ray caster puts its picture, but for the blur, which is none in the window's middle.

    Its ray of a pixel goes through the pixel's lower left corner, and of its picture the middles of the outer pixels are drawn onto
    the window's edges, which stretches it by a pixel: what belongs to x of -1 to 1 is seen at (x + 1) n / (n - 1) - 1 where there are n pixels.
    """
    matrix = vtkMatrix4x4()
    for axis, pixels in enumerate(size):
        matrix.SetElement(axis, axis, 1.0 - 1.0 / pixels)
        matrix.SetElement(axis, 3, -1.0 / pixels)
    transform = vtkMatrixToHomogeneousTransform()
    transform.SetInput(matrix)
    camera.SetUserTransform(transform)


def mapper_of(job):
    """The mapper that the job names, at one ray a pixel."""
    if job["mapper"] == "projected-tetrahedra":
        return vtkProjectedTetrahedraMapper()
    mapper = vtkUnstructuredGridVolumeRayCastMapper()
    mapper.SetRayIntegrator(vtkUnstructuredGridPartialPreIntegration())
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetImageSampleDistance(1.0)
    return mapper


def picture(window, job, brightest):
    """What the window shows in its middle: floats, upper row first."""
    width, height = job["size"]
    left, bottom = [margin(job) // 2 * pixels for pixels in job["size"]]
    floats = vtkFloatArray()
    window.GetRGBAPixelData(left, bottom, left + width - 1, bottom + height - 1, 0, floats)
    rows = memoryview(floats).cast("B")
    row = 16 * width
    flipped = bytearray()
    for y in reversed(range(height)):
        flipped += rows[y * row : (y + 1) * row]
    values = memoryview(flipped).cast("f")
    if brightest != 1.0:
        for i in range(len(values)):
            if i % 4 != 3:
                values[i] *= brightest
    return flipped


def draw(job):
    """Draws two frames and writes them."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(job["mesh"])
    reader.Update()
    mesh = reader.GetOutput()
    mesh.GetPointData().SetActiveScalars(job["field"])
    low, high = mesh.GetPointData().GetScalars().GetRange()

    mapper = mapper_of(job)
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectScalarArray(job["field"])
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume_property, brightest = transfer(job, low, high)
    volume.SetProperty(volume_property)

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    window.SetSize(*[margin(job) * pixels for pixels in job["size"]])
    renderer = vtkRenderer()
    renderer.SetBackground(0.0, 0.0, 0.0)
    renderer.SetBackgroundAlpha(0.0)
    renderer.AddVolume(volume)
    place(renderer.GetActiveCamera(), job, mesh)
    window.AddRenderer(renderer)
    # The second frame may differ from the first.
    for path in job["pictures"]:
        window.Render()
        with open(path, "wb") as file:
            file.write(picture(window, job, brightest))


def main():
    if len(sys.argv) == 1:
        print(vtkVersion.GetVTKVersion())
        return
    with open(sys.argv[1], encoding="utf-8") as file:
        draw(json.load(file))


main()
