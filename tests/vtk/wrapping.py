"""The wrapped module in the Python of the VTK that it is built for: each class, an error."""

import math
import random
import unittest

from symsurf_filters import vtkSymsurfFilters as symsurf

try:
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
except ImportError:  # PyVista's build of VTK
    from cvista.vtkCommonCore import vtkPoints
    from cvista.vtkCommonDataModel import vtkPolyData

NORMAL, OFFSET = (2 / 3, -1 / 3, 2 / 3), 0.4
COUNT = 400


def distance(point):
    return sum(n * x for n, x in zip(NORMAL, point)) - OFFSET


def reflected(point):
    return [x - 2 * distance(point) * n for n, x in zip(NORMAL, point)]


def mirrored_shape():
    """A lopsided ball's points, then their images over the plane."""
    rng = random.Random(7)
    ball = []
    for _ in range(COUNT):
        x, y, z = (rng.gauss(0, 1) for _ in range(3))
        scale = (1 + 0.3 * math.sin(3 * x + y)) / math.hypot(x, y, z)
        ball.append([scale * x, scale * y, scale * z])
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for point in ball + [reflected(point) for point in ball]:
        points.InsertNextPoint(point)
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def errors_of(algorithm):
    """What the algorithm says is wrong while it updates."""
    said = []

    def heard(_caller, _event, text):
        said.append(text)

    heard.CallDataType = "string0"
    tags = [(o, o.AddObserver("ErrorEvent", heard)) for o in (algorithm, algorithm.GetExecutive())]
    algorithm.Update()
    for observed, tag in tags:
        observed.RemoveObserver(tag)
    return "".join(said)


class Wrapping(unittest.TestCase):
    def setUp(self):
        self.shape = mirrored_shape()
        self.detection = symsurf.vtkMirrorDetection()
        self.detection.SetMethod("plane")
        self.detection.SetInputData(self.shape)

    def assert_points_equal(self, point, expected):
        for x, y in zip(point, expected):
            self.assertAlmostEqual(x, y, 9)

    def test_detection_finds_the_known_plane(self):
        self.assertEqual(errors_of(self.detection), "")
        mirror = self.detection.GetOutput(symsurf.vtkMirrorDetection.MIRROR)
        fields = mirror.GetFieldData()
        self.assertEqual(fields.GetAbstractArray("Kind").GetValue(0), "plane")
        self.assertGreater(fields.GetArray("Score").GetValue(0), 0.9)
        self.assertGreater(mirror.GetNumberOfPolys(), 0)
        surface = self.detection.GetOutput(symsurf.vtkMirrorDetection.SURFACE_POINTS)
        self.assertEqual(surface.GetNumberOfPoints(), 2 * COUNT)
        for data in (mirror, surface):
            for i in range(data.GetNumberOfPoints()):
                self.assertAlmostEqual(distance(data.GetPoint(i)), 0, 9)
        shape = self.detection.GetOutput()
        partners = shape.GetPointData().GetArray("MirrorPartner")
        for i in range(COUNT):
            self.assertEqual(partners.GetValue(i), COUNT + i)
            self.assertEqual(partners.GetValue(COUNT + i), i)

    def test_reflection_follows_the_detected_mirror(self):
        reflection = symsurf.vtkMirrorReflection()
        reflection.SetInputData(self.shape)
        reflection.SetMirrorConnection(
            self.detection.GetOutputPort(symsurf.vtkMirrorDetection.MIRROR)
        )
        self.assertEqual(errors_of(reflection), "")
        self.assertEqual(reflection.GetOutput().GetNumberOfPoints(), 2 * COUNT)
        for i in range(2 * COUNT):
            image = reflection.GetOutput().GetPoint(i)
            self.assert_points_equal(image, reflected(self.shape.GetPoint(i)))

    def test_operations_follow_the_detected_mirror(self):
        wrapped = [each for each in vars(symsurf).values() if isinstance(each, type)]
        base = symsurf.vtkMirrorOperation
        filters = [each for each in wrapped if issubclass(each, base) and each is not base]
        self.assertGreaterEqual(len(filters), 6)
        for made in filters:
            operation = made()
            operation.SetInputData(self.shape)
            operation.SetMirrorConnection(
                self.detection.GetOutputPort(symsurf.vtkMirrorDetection.MIRROR)
            )
            if made is symsurf.vtkMirrorRemeshing:
                self.assertIn("remesh needs a mesh", errors_of(operation))
                continue
            self.assertEqual(errors_of(operation), "")
            kept = COUNT if made is symsurf.vtkMirrorCut else 2 * COUNT
            self.assertGreaterEqual(operation.GetOutput().GetNumberOfPoints(), kept)

        correspondences = symsurf.vtkMirrorCorrespondences()
        correspondences.SetInputData(self.shape)
        correspondences.SetOneToOne(True)
        correspondences.SetMethod("plane")
        self.assertEqual(errors_of(correspondences), "")
        index = correspondences.GetOutput().GetPointData().GetArray("MirrorCorrespondencesIndex")
        found = [index.GetValue(i) for i in range(COUNT)]
        self.assertTrue(all(j in (COUNT + i, -1) for i, j in enumerate(found)))
        self.assertLess(found.count(-1), COUNT / 10)
        correspondences.SetMaxAngle(91)
        self.assertIn("max_angle is 91", errors_of(correspondences))

    def test_analysis_finds_the_mirror_among_the_symmetries(self):
        analysis = symsurf.vtkSymmetryAnalysis()
        analysis.SetInputData(self.shape)
        self.assertEqual(errors_of(analysis), "")
        fields = analysis.GetOutput(symsurf.vtkSymmetryAnalysis.SHAPE).GetFieldData()
        self.assertEqual(fields.GetAbstractArray("Group").GetValue(0), "Cs")
        elements = analysis.GetOutput(symsurf.vtkSymmetryAnalysis.ELEMENTS)
        self.assertGreater(elements.GetNumberOfPolys(), 0)
        for i in range(elements.GetNumberOfPoints()):
            # Point groups are fitted to some of the points.
            self.assertAlmostEqual(distance(elements.GetPoint(i)), 0, delta=2e-3)

    def test_sample_knows_its_mirror(self):
        source = symsurf.vtkMirrorSampleSource()
        source.SetGenerator("perpendicular")
        source.Update()
        sample = source.GetOutput(symsurf.vtkMirrorSampleSource.SAMPLE)
        partners = sample.GetPointData().GetArray("MirrorPartner")
        self.assertGreater(sample.GetNumberOfPoints(), 0)
        for i in range(sample.GetNumberOfPoints()):
            self.assertEqual(partners.GetValue(partners.GetValue(i)), i)
        mirror = source.GetOutput(symsurf.vtkMirrorSampleSource.MIRROR)
        self.assertGreater(mirror.GetNumberOfPolys(), 0)

    def test_damage_is_drawn_by_its_seed(self):
        counts = []
        for seed in (1, 1, 2):
            damage = symsurf.vtkPointDamage()
            damage.SetDamage("noise")
            damage.SetSeed(seed)
            damage.SetInputData(self.shape)
            damage.Update()
            counts.append([damage.GetOutput().GetPoint(i) for i in range(2 * COUNT)])
        self.assertEqual(counts[0], counts[1])
        self.assertNotEqual(counts[0], counts[2])

    def test_errors_leave_no_output(self):
        self.detection.SetMethod("horoscope")
        self.assertIn("horoscope", errors_of(self.detection))
        self.assertEqual(self.detection.GetOutput().GetNumberOfPoints(), 0)
        self.detection.SetMethod("plane")
        self.assertEqual(errors_of(self.detection), "")
        self.assertGreater(self.detection.GetOutput().GetNumberOfPoints(), 0)


if __name__ == "__main__":
    unittest.main()
