# Opens frames of Whirl in ParaView, arranged:
#   paraview --script=@script@
#   pvbatch @script@ picture.png [time]      a picture without a window
# Frames that there are: @sets@
import os
import sys

from paraview.simple import *

shown = "@shown@"
kinds = @kinds@
folder = @folder@
if not os.path.isdir(folder):  # moved since: the script goes along
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "vtk")

paraview.simple._DisableFirstRenderCameraReset()
black, grey, paint = [0.0, 0.0, 0.0], [0.45, 0.45, 0.45], [0.1, 0.1, 0.1]


def frames(kind):
    stem, name = os.path.join(folder, f"{shown}_{kind}"), f"{shown} {kind}"
    if os.path.exists(stem + ".pvd"):
        return PVDReader(registrationName=name, FileName=stem + ".pvd")
    return VTKHDFReader(registrationName=name, FileName=[stem + ".vtkhdf"])  # ParaView 5.12 and later


def new_view(title):
    view = CreateView("RenderView")
    view.Background = [1.0, 1.0, 1.0]
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesLabelColor = black
    view.CameraParallelProjection = 1
    label = Text(registrationName=title, Text=title)
    text = Show(label, view)
    text.Color = black
    text.FontSize = 14
    text.WindowLocation = "Upper Center"
    return view


def span(source, array):
    """Smallest and largest magnitude over a dozen of the frames."""
    low, high = 1e300, 0.0
    for time in times[:: max(1, len(times) // 12)] + times[-1:]:
        source.UpdatePipeline(time)
        values = source.PointData[array]
        r = values.GetRange(-1 if values.GetNumberOfComponents() > 1 else 0)
        low, high = min(low, r[0]), max(high, r[1])
    return low, high


def coloured(display, view, source, array):
    several = source.PointData[array].GetNumberOfComponents() > 1
    ColorBy(display, ("POINTS", array, "Magnitude") if several else ("POINTS", array))
    table = GetColorTransferFunction(array)
    table.RescaleTransferFunction(*span(source, array))
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(table, view)
    bar.Title = array
    bar.ComponentTitle = ""
    bar.TitleColor = bar.LabelColor = black
    bar.WindowLocation = "Lower Right Corner"


def plain(display, colour):
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour


def names(source, array):
    field = servermanager.Fetch(source).GetFieldData().GetAbstractArray(array)
    return [field.GetValue(i) for i in range(field.GetNumberOfValues())] if field else []


def arrays(source):
    return {array.Name: array for array in source.PointData}


def part(source, name, value, view):
    chosen = Threshold(registrationName=name, Input=source)
    chosen.Scalars = ["CELLS", "stripe"]
    chosen.ThresholdMethod = "Above Upper Threshold" if value else "Below Lower Threshold"
    chosen.LowerThreshold = chosen.UpperThreshold = 0.5
    return chosen, Show(chosen, view)


sources = {kind: frames(kind) for kind in kinds}
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
first = next(iter(sources.values()))
times = list(first.TimestepValues) if first.TimestepValues is not None else [0.0]
for source in sources.values():
    source.UpdatePipeline(times[0])
views = []

if "surface" in sources:
    view = new_view(f"{shown}: surface")
    views.append(view)
    body, shaft = part(sources["surface"], "surface without stripe", 0, view)
    coloured(shaft, view, sources["surface"], "displacement [m]")
    stripe, painted = part(sources["surface"], "spin stripe", 1, view)
    plain(painted, paint)
    if "orbits" in sources:  # they run inside
        shaft.Opacity, painted.Opacity = 0.4, 0.6
    print("parts:", ", ".join(f"{k} {name}" for k, name in enumerate(names(sources["surface"], "part names"))))

if "line" in sources:
    view = new_view(f"{shown}: centre line")
    views.append(view)
    known = arrays(sources["line"])
    tube = Tube(registrationName="centre line as a tube", Input=sources["line"])
    if "radius [m]" in known:
        tube.Scalars = ["POINTS", "radius [m]"]
        tube.VaryRadius = "By Absolute Scalar"
    tube.NumberofSides = 24
    by = "von_mises [Pa]" if "von_mises [Pa]" in known else "displacement [m]"
    coloured(Show(tube, view), view, sources["line"], by)

for view in views:
    if "bearings" in sources:
        springs = Show(sources["bearings"], view)
        plain(springs, grey)
        springs.LineWidth = 1.5
        pushed = arrays(sources["bearings"]).get("force [N]")
        largest = pushed.GetRange(-1)[1] if pushed else 0.0
        if largest > 0:
            bounds = first.GetDataInformation().GetBounds()
            arrows = Glyph(registrationName="forces of supports", Input=sources["bearings"], GlyphType="Arrow")
            arrows.OrientationArray = ["POINTS", "force [N]"]
            arrows.ScaleArray = ["POINTS", "force [N]"]
            arrows.ScaleFactor = 0.15 * (bounds[1] - bounds[0]) / largest
            arrows.GlyphMode = "All Points"
            plain(Show(arrows, view), [0.75, 0.2, 0.1])
    if "orbits" in sources:
        bounds = first.GetDataInformation().GetBounds()
        tubes = Tube(registrationName="orbits as tubes", Input=sources["orbits"])
        tubes.Radius = 0.0025 * max(bounds[k + 1] - bounds[k] for k in (0, 2, 4))
        tubes.NumberofSides = 8
        plain(Show(tubes, view), [0.1, 0.3, 0.8])

stated = names(first, "deformation scale")
for view in views:
    time = AnnotateTimeFilter(registrationName="time", Input=first)
    time.Format = "t = {time:.5g} s" + (f", displacements drawn {stated[0]} times" if stated else "")
    clock = Show(time, view)
    clock.Color = black
    clock.FontSize = 12
    clock.WindowLocation = "Lower Left Corner"

# all frames in the picture: the box of the first, middle and last one
box = [1e30, -1e30] * 3
for time in (times[0], times[len(times) // 2], times[-1]):
    for source in sources.values():
        source.UpdatePipeline(time)
        bounds = source.GetDataInformation().GetBounds()
        for k in range(0, 6, 2):
            if bounds[k] <= bounds[k + 1]:
                box[k] = min(box[k], bounds[k])
                box[k + 1] = max(box[k + 1], bounds[k + 1])
sides = [box[k + 1] - box[k] for k in (0, 2, 4)]
centre = [0.5 * (box[k] + box[k + 1]) for k in (0, 2, 4)]
size = max(sides)
layout = CreateLayout(name=shown)
if len(views) == 2:
    layout.SplitVertical(0, 0.5)
for k, view in enumerate(views):
    AssignViewToLayout(view=view, layout=layout, hint=k + 1 if len(views) == 2 else 0)
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[0] - 0.5 * size, centre[1] - 1.2 * size, centre[2] + 0.6 * size]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraParallelScale = max(0.26 * sides[0], 0.62 * sides[1], 0.62 * sides[2])
    if k > 0:
        AddCameraLink(views[0], view, f"camera {k}")
scene.AnimationTime = times[0]

picture = sys.argv[1] if len(sys.argv) > 1 and sys.argv[1].endswith(".png") else None
if picture:
    asked = float(sys.argv[2]) if len(sys.argv) > 2 else times[-1]
    scene.AnimationTime = asked
    layout.SetSize(1400, 600 * len(views))
    for view in views:
        view.ViewTime = asked
        Render(view)
    SaveScreenshot(picture, layout, ImageResolution=[1400, 600 * len(views)])
