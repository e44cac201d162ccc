# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a mesh beside its nodal result, one per level and one of all levels.

All of them share one camera, one colour map and one range. Needs a display (xvfb-run)."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkActor2D, vtkPolyDataMapper, vtkPolyDataMapper2D, vtkRenderer, vtkRenderWindow,
    vtkTextMapper)
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the OpenGL back end)

INK = (0.13, 0.15, 0.18)
PAPER = (1.0, 1.0, 1.0)

# Viridis at nine even places
VIRIDIS = ((0.267, 0.005, 0.329), (0.279, 0.175, 0.483), (0.230, 0.322, 0.546),
           (0.173, 0.449, 0.558), (0.128, 0.567, 0.551), (0.158, 0.684, 0.502),
           (0.369, 0.789, 0.383), (0.678, 0.864, 0.190), (0.993, 0.906, 0.144))


# From nearly white, on which thin edges are seen, to dark red
HEAT = ((0.96, 0.96, 0.93), (0.99, 0.93, 0.70), (1.00, 0.82, 0.42), (0.99, 0.66, 0.28),
        (0.97, 0.47, 0.20), (0.89, 0.27, 0.16), (0.73, 0.12, 0.15), (0.50, 0.03, 0.15))

BANDS = 20


def colour_map(low, high, colours=VIRIDIS):
    """Bands, as on a contour plot: their outlines show small differences that a smooth map hides."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(BANDS)
    table.SetTableRange(low, high)
    for i in range(BANDS):
        at = i / (BANDS - 1) * (len(colours) - 1)
        k = min(int(at), len(colours) - 2)
        rgb = [a + (b - a) * (at - k) for a, b in zip(colours[k], colours[k + 1])]
        table.SetTableValue(i, *rgb, 1.0)
    return table


FINE = 2  # drawn this many times larger, then averaged: thin lines stay even


class Sheet:
    """One window with meshes, words and a scalar bar at given places (pixels, from the lower left)."""

    window = None  # one for all sheets: shaders are compiled once

    def __init__(self, width, height):
        self.size = width, height
        if not Sheet.window:
            Sheet.window = vtkRenderWindow()
            self.window.SetOffScreenRendering(1)
            self.window.SetMultiSamples(0)
        self.window.SetSize(FINE * width, FINE * height)
        self.window.GetRenderers().RemoveAllItems()
        self.paper = vtkRenderer()
        self.paper.SetBackground(*PAPER)
        self.window.AddRenderer(self.paper)

    def renderer(self, x, y, width, height):
        renderer = vtkRenderer()
        renderer.SetBackground(*PAPER)
        renderer.SetViewport(x / self.size[0], y / self.size[1],
                             (x + width) / self.size[0], (y + height) / self.size[1])
        self.window.AddRenderer(renderer)
        return renderer

    def mesh(self, mesh, box, place, array=None, colours=None):
        """A mesh, seen along -z; with its edges, or with an array in colours. `box`: bounds that fill
        the place, so that all meshes are shown at the same scale."""
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(mesh)
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.LightingOff()
        if array:
            mapper.SetScalarModeToUsePointFieldData()
            mapper.SelectColorArray(array)
            mapper.SetLookupTable(colours)
            mapper.UseLookupTableScalarRangeOn()
            mapper.InterpolateScalarsBeforeMappingOn()
        else:
            mapper.ScalarVisibilityOff()
            look.SetColor(0.93, 0.95, 0.97)
        renderer = self.renderer(*place)
        renderer.AddActor(actor)
        if not array:
            edges = vtkActor()
            edges.SetMapper(mapper)
            look = edges.GetProperty()
            look.LightingOff()
            look.SetRepresentationToWireframe()
            look.SetColor(0.16, 0.25, 0.37)
            look.SetOpacity(0.8)
            look.SetLineWidth(0.6 * FINE)
            edges.SetPosition(0, 0, 0.001 * (box[1] - box[0]))
            renderer.AddActor(edges)
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        centre = [(box[i] + box[i + 1]) / 2 for i in (0, 2, 4)]
        camera.SetFocalPoint(*centre)
        camera.SetPosition(centre[0], centre[1], centre[2] + 1)
        camera.SetParallelScale(max((box[3] - box[2]), (box[1] - box[0]) * place[3] / place[2]) * 0.505)
        renderer.ResetCameraClippingRange()

    def solid(self, mesh, look_from, up, height, centre, place, array, colours):
        """A mesh in space with its edges, the sides of its quads and triangles, and an array in colours.
        look_from: direction; height of what the place shows, in the mesh's unit, and its centre."""
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(mesh)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(array)
        mapper.SetLookupTable(colours)
        mapper.UseLookupTableScalarRangeOn()
        mapper.InterpolateScalarsBeforeMappingOn()
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.SetInterpolationToFlat()
        look.SetAmbient(0.4)
        look.SetDiffuse(0.65)
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.25, 0.28, 0.33)
        look.SetLineWidth(0.5 * FINE)
        renderer = self.renderer(*place)
        renderer.AddActor(actor)
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*centre)
        camera.SetPosition(*(c + height * d for c, d in zip(centre, look_from)))
        camera.SetViewUp(*up)
        camera.SetParallelScale(height / 2)
        renderer.ResetCameraClippingRange()

    def slider(self, text, fraction, x, y, width):
        """A slider that stands at a fraction of its width, with words above it."""
        self.words(text, x, y + 16, 16)
        for left, right, thickness, colour in (
                (x, x + width, 4, (0.8, 0.82, 0.85)),
                (x, x + fraction * width, 4, (0.13, 0.57, 0.55)),
                (x + fraction * width - 5, x + fraction * width + 5, 16, INK)):
            points = vtkPoints()
            for corner in ((left, y - thickness / 2), (right, y - thickness / 2),
                           (right, y + thickness / 2), (left, y + thickness / 2)):
                points.InsertNextPoint(FINE * corner[0], FINE * corner[1], 0)
            face = vtkCellArray()
            face.InsertNextCell(4, (0, 1, 2, 3))
            bar = vtkPolyData()
            bar.SetPoints(points)
            bar.SetPolys(face)
            mapper = vtkPolyDataMapper2D()
            mapper.SetInputData(bar)
            actor = vtkActor2D()
            actor.SetMapper(mapper)
            actor.GetProperty().SetColor(*colour)
            self.paper.AddActor2D(actor)

    def words(self, text, x, y, size, bold=False, centred=False, grey=False):
        mapper = vtkTextMapper()
        mapper.SetInput(text)
        look = mapper.GetTextProperty()
        look.SetFontFamilyToArial()
        look.SetFontSize(FINE * size)
        look.SetColor(*((0.38, 0.42, 0.47) if grey else INK))
        look.SetBold(bold)
        if centred:
            look.SetJustificationToCentered()
        actor = vtkActor2D()
        actor.SetMapper(mapper)
        actor.SetPosition(FINE * x, FINE * y)
        self.paper.AddActor2D(actor)

    def scalar_bar(self, colours, title, place, size, digits=0):
        bar = vtkScalarBarActor()
        bar.SetLookupTable(colours)
        bar.SetTitle(title)
        bar.SetNumberOfLabels(6)
        bar.SetLabelFormat(f"%.{digits}f")
        bar.UnconstrainedFontSizeOn()
        bar.SetMaximumWidthInPixels(10000)
        bar.SetMaximumHeightInPixels(10000)
        bar.SetBarRatio(0.3)
        bar.SetVerticalTitleSeparation(FINE * size // 2)
        for look in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
            look.SetFontFamilyToArial()
            look.SetFontSize(FINE * size)
            look.SetColor(*INK)
            look.ItalicOff()
            look.BoldOff()
            look.ShadowOff()
        x, y, width, height = (FINE * i for i in place)
        bar.GetPositionCoordinate().SetCoordinateSystemToDisplay()
        bar.GetPositionCoordinate().SetValue(x, y)
        bar.GetPosition2Coordinate().SetCoordinateSystemToDisplay()
        bar.GetPosition2Coordinate().SetValue(width, height)
        self.paper.AddActor2D(bar)

    def image(self):
        """The sheet as vtkImageData of RGB."""
        self.window.Render()
        width, height = self.size
        grabbed = vtkUnsignedCharArray()
        self.window.GetPixelData(0, 0, FINE * width - 1, FINE * height - 1, 0, grabbed, 0)
        fine = vtk_to_numpy(grabbed).reshape(FINE * height, FINE * width, 3).astype(np.uint16)
        pixels = sum(fine[i::FINE, j::FINE] for i in range(FINE) for j in range(FINE))
        pixels = ((pixels + FINE * FINE // 2) // (FINE * FINE)).astype(np.uint8)
        image = vtkImageData()
        image.SetDimensions(width, height, 1)
        image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=1))
        return image

    def write(self, path):
        writer = vtkPNGWriter()
        writer.SetFileName(path)
        writer.SetCompressionLevel(6)
        writer.SetInputData(self.image())
        writer.Write()
        if writer.GetErrorCode():
            raise OSError("cannot write " + path)


def draw_level(path, mesh, title, notes, array, unit, limits, box):
    """One level: the mesh with its edges, the result beside it, a scalar bar; a note above each."""
    sheet = Sheet(1250, 690)
    colours = colour_map(*limits)
    sheet.words(title, 25, 645, 24, bold=True)
    for i, note in enumerate(notes):
        x = 25 + 580 * i
        sheet.words(note, x, 614, 16, grey=True)
        sheet.mesh(mesh, box, (x, 25, 565, 565), array if i else None, colours)
    sheet.scalar_bar(colours, unit, (1175, 25, 70, 565), 16)
    sheet.write(path)


def draw_overview(path, levels, array, unit, limits, box):
    """All levels side by side: meshes above, results below. levels: (mesh, caption, note)."""
    tile, gap = 290, 14
    width = 30 + len(levels) * (tile + gap) + 90
    top = 2 * tile + gap + 30
    sheet = Sheet(width, top + 70)
    colours = colour_map(*limits)
    for i, (mesh, caption, note) in enumerate(levels):
        x = 30 + i * (tile + gap)
        sheet.words(caption, x, top + 32, 18, bold=True)
        sheet.words(note, x, top + 8, 15, grey=True)
        sheet.mesh(mesh, box, (x, 20 + tile + gap, tile, tile))
        sheet.mesh(mesh, box, (x, 20, tile, tile), array, colours)
    sheet.scalar_bar(colours, unit, (width - 92, 20, 84, tile), 15)
    sheet.write(path)
