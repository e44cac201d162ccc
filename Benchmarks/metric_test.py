# SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the error tool and of the comparison on cases with known answers: run.sh test"""
import unittest

import numpy as np

import meshes
from field_results import OURS, Comparison, keeps_topology, mean
from metric import Reference, shape


def flat_grid(n):
    points, triangles, _ = meshes.grid(n)
    points[:, 2] = 0
    return points, triangles


class Distances(unittest.TestCase):
    def test_shifted_plane(self):
        points, triangles = flat_grid(11)
        row = Reference(points, triangles).measure(points + [0, 0, .01], triangles)
        self.assertAlmostEqual(row["hausdorff"], .01 / 2 ** .5, places=6)
        self.assertAlmostEqual(row["rms"], .01 / 2 ** .5, places=6)

    def test_missing_part_counts_from_the_original_only(self):
        points, triangles = flat_grid(11)
        left = triangles[points[triangles][:, :, 0].max(1) < .51]
        row = Reference(points, triangles).measure(points, left)
        self.assertAlmostEqual(row["forth"], .5 / 2 ** .5, places=6)
        self.assertLess(row["back"], 1e-6)

    def test_array(self):
        points, triangles = flat_grid(11)
        reference = Reference(points, triangles, points[:, 0])
        off = points[:, 0].copy()
        off[0] += .25  # one node, whose triangles are 1/100 of the area
        exact = reference.measure(points, triangles, points[:, 0])
        row = reference.measure(points, triangles, off)
        self.assertLess(exact["value_largest"], 1e-6)
        self.assertAlmostEqual(row["value_largest"], .25, places=5)
        self.assertLess(row["value_mean"], .01)


class Faults(unittest.TestCase):
    def setUp(self):
        self.points, self.triangles, _ = meshes.grid(21)
        self.reference = Reference(self.points, self.triangles)

    def faults(self, points, triangles):
        f = self.reference.faults(points, triangles)
        return f["flipped_near"], f["folded"], f["degenerate"]

    def test_none_in_the_original(self):
        self.assertEqual(self.faults(self.points, self.triangles), (0, 0, 0))

    def test_flipped(self):
        triangles = self.triangles.copy()
        triangles[100] = triangles[100, ::-1]
        flipped, folded, degenerate = self.faults(self.points, triangles)
        self.assertEqual((flipped, degenerate), (1, 0))

    def test_folded(self):
        points = self.points.copy()
        points[:, 2] = 0
        self.reference = Reference(points, self.triangles)
        # A node moved over to the other side of its ring lays triangles on each other.
        points[10 * 21 + 10, :2] += [.08, .03]
        flipped, folded, _ = self.faults(points, self.triangles)
        self.assertGreater(flipped, 0)
        self.assertGreater(folded, 0)

    def test_folds_of_the_reference(self):
        points = self.points.copy()
        points[:, 2] = 0
        points[10 * 21 + 10, :2] += [.08, .03]
        self.reference = Reference(points, self.triangles)
        self.assertEqual(self.faults(points, self.triangles)[:2], (0, 0))
        # Others of the same mesh count as before.
        points = points.copy()
        points[15 * 21 + 15, :2] += [.08, .03]
        flipped, folded, _ = self.faults(points, self.triangles)
        self.assertGreater(flipped, 0)
        self.assertGreater(folded, 0)

    def test_degenerate(self):
        points = self.points.copy()
        a, b, c = self.triangles[100]
        points[b] = .5 * (points[a] + points[c])
        self.assertEqual(self.faults(points, self.triangles)[2], 1)

    def test_aspect_ratio(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [.5, .75 ** .5, 0], [2, 0, 0]])
        thin, aspect = shape(points, np.array([[0, 1, 2], [0, 1, 3]]))
        self.assertAlmostEqual(aspect[0], 1)
        self.assertEqual(thin[1], 0)
        self.assertGreater(aspect[1], 1e5)


class Comparisons(unittest.TestCase):
    @staticmethod
    def row(tool, hausdorff, triangles=100, wanted=100):
        return {"tool": tool, "hausdorff": hausdorff, "rms": hausdorff, "triangles": triangles, "wanted": wanted,
                "failed": None}

    @staticmethod
    def table(mine, **theirs):
        return {("mesh", 10.0): {OURS: mine, **theirs}}

    def test_best_of_all_and_floor(self):
        c = Comparison(self.table(self.row(OURS, 2e-3), MeshLib=self.row("MeshLib", 4e-3), Blender=self.row("Blender", 1e-5)))
        (r, _, _, best), = c.against("hausdorff")
        self.assertEqual(best["tool"], "Blender")
        self.assertAlmostEqual(r, 20)  # 1e-5 counts as the floor, 1e-4
        self.assertAlmostEqual(mean(c.against("hausdorff", lambda n: n == "MeshLib")), .5)

    def test_results_of_another_topology_can_be_left_out(self):
        row = lambda tool, hausdorff, **changed: dict(self.row(tool, hausdorff), **{"nonmanifold": 0, "euler": 0, **changed})
        c = Comparison(self.table(row(OURS, 2e-3), MeshLib=row("MeshLib", 1e-3, euler=-2), Open3D=row("Open3D", 1e-3, nonmanifold=1),
                                  Blender=row("Blender", 4e-3)))
        self.assertAlmostEqual(mean(c.against("hausdorff")), 2)
        self.assertAlmostEqual(mean(c.against("hausdorff", fits=keeps_topology)), .5)

    def test_a_rival_off_the_count_is_left_out(self):
        c = Comparison(self.table(self.row(OURS, 2e-3), MeshLib=self.row("MeshLib", 1e-3, triangles=103),
                                  Blender=self.row("Blender", 4e-3, triangles=102)))
        self.assertEqual([n for _, n, _ in c.left_out], ["MeshLib"])
        self.assertAlmostEqual(mean(c.against("hausdorff")), .5)

    def test_ours_off_the_count_is_in_no_mean(self):
        c = Comparison(self.table(self.row(OURS, 2e-3, triangles=130), Blender=self.row("Blender", 4e-3)))
        self.assertEqual((len(c.cases), len(c.early)), (0, 1))


if __name__ == "__main__":
    unittest.main()
