"""What `selvage convert` writes, opened by readers that are not ours; what others write, read by it.

usage: foreign_readers.py numpy|vtk|blender PROGRAM
Exit code 77 (skipped) where the reader is not installed.
"""
import collections
import importlib.util
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from fractions import Fraction

reader, program = sys.argv[1:3]
if reader == "blender" and shutil.which("blender") is None:
    print("skipped: no blender (packages-readers.txt names the Debian packages)")
    sys.exit(77)
for module in {"numpy", "vtk" if reader == "vtk" else "numpy"}:
    if importlib.util.find_spec(module) is None:
        print(f"skipped: Python has no {module} (packages-readers.txt names the Debian packages)")
        sys.exit(77)

import numpy as np


def convert(*arguments):
    subprocess.run([program, "convert", *arguments], check=True, stdout=subprocess.PIPE)


def same_bits(a, b):
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


def hard_doubles(shape):
    """Finite doubles of every exponent, both signs, subnormal and zero ones among them."""
    bits = np.random.default_rng(20020721).integers(0, 2**64, size=shape, dtype=np.uint64)
    values = bits.view(np.float64)
    values[~np.isfinite(values)] = -0.0
    values.flat[:4] = [-0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308]
    return values


def hard_floats(shape):
    bits = np.random.default_rng(7).integers(0, 2**32, size=shape, dtype=np.uint32)
    values = bits.view(np.float32)
    values[~np.isfinite(values)] = -0.0
    values.flat[:2] = [1e-45, 3.4028235e38]
    return values


def side(p, triangle):
    """Six times the volume of p and the triangle."""
    a, b, c = ([x - y for x, y in zip(corner, p)] for corner in triangle)
    return sum(a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))


def pierce(first, second):
    """Whether an edge of one triangle passes through the other, its boundary included, out of its plane."""
    for a, b in ((first, second), (second, first)):
        for i in range(3):
            p, q = a[i], a[(i + 1) % 3]
            if side(p, b) * side(q, b) >= 0:
                continue
            turns = [side(p, (q, b[k], b[(k + 1) % 3])) for k in range(3)]
            if min(turns) >= 0 or max(turns) <= 0:
                return True
    return False


class Case(unittest.TestCase):
    FRAMES, VERTICES = 5, 40

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.faces = np.array([[i, i + 1, i + 2] for i in range(self.VERTICES - 2)], dtype=np.int32)
        self.group = (np.arange(len(self.faces)) >= 30).astype(np.uint8)
        self.doubles = hard_doubles((self.FRAMES, self.VERTICES, 3))
        self.floats = hard_floats((self.FRAMES, self.VERTICES, 3))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def save(self, positions):
        np.savez(self.path("in.npz"), V=positions, F=self.faces, group=self.group)
        return self.path("in.npz")

    def write_obj(self, name):
        """A base mesh: only its faces count."""
        with open(self.path(name), "w", encoding="ascii") as file:
            file.writelines("v 0 0 0\n" for _ in range(self.VERTICES))
            file.writelines("f %d %d %d\n" % tuple(face + 1) for face in self.faces)


class NumPy(Case):
    def test_npz(self):
        for positions in (self.doubles, self.floats):
            source = self.save(positions)
            convert(source, "-o", self.path("out.npz"))
            with np.load(self.path("out.npz")) as out:
                self.assertTrue(same_bits(out["V"], positions))
                self.assertTrue(same_bits(out["F"], self.faces))
                self.assertTrue(same_bits(out["group"], self.group))
            os.remove(self.path("out.npz"))

    def test_folder(self):
        convert(self.save(self.doubles), "-o", self.path("run"))
        with open(self.path("run/frames.jsonl"), encoding="utf-8") as file:
            frames = [json.loads(line) for line in file]
        positions = np.stack([np.load(self.path("run/" + frame["file"])) for frame in frames])
        self.assertTrue(same_bits(positions, self.doubles))
        self.assertTrue(same_bits(np.load(self.path("run/faces.npy")), self.faces))

    def test_obj(self):
        convert(self.save(self.doubles), "-o", self.path("out.obj"))
        for i in range(self.FRAMES):
            with open(self.path("out_%06d.obj" % i), encoding="ascii") as file:
                lines = [line.split() for line in file]
            positions = np.array([[float(x) for x in line[1:]] for line in lines if line[0] == "v"])
            self.assertTrue(same_bits(positions, self.doubles[i]))
            faces = [[int(k) - 1 for k in line[1:]] for line in lines if line[0] == "f"]
            self.assertEqual(faces, self.faces.tolist())
            self.assertEqual([line[1] for line in lines if line[0] == "g"], ["cloth", "body"])

    def test_pc2(self):
        """Rounded as numpy rounds."""
        small = np.clip(self.doubles, -3e38, 3e38)
        convert(self.save(small), "-o", self.path("out.pc2"))
        with open(self.path("out.pc2"), "rb") as file:
            signature, version, vertices, start, rate, frames = struct.unpack("<12siiffi", file.read(32))
            positions = np.frombuffer(file.read(), dtype="<f4")
        self.assertEqual((signature, version, vertices), (b"POINTCACHE2\0", 1, self.VERTICES))
        self.assertEqual((start, rate, frames), (0, 1, self.FRAMES))
        self.assertTrue(same_bits(positions.reshape(small.shape), small.astype(np.float32)))

    def test_pc2_is_read(self):
        self.write_obj("in.obj")
        with open(self.path("in.pc2"), "wb") as file:
            file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, self.VERTICES, 1.0, 2.0, self.FRAMES))
            file.write(self.floats.astype("<f4").tobytes())
        convert(self.path("in.pc2"), "-o", self.path("out.npz"))
        with np.load(self.path("out.npz")) as out:
            self.assertTrue(same_bits(out["V"], self.floats))
            self.assertTrue(same_bits(out["F"], self.faces))

    def test_mdd_is_read(self):
        self.write_obj("base.obj")
        times = [0.25 * i for i in range(self.FRAMES)]
        with open(self.path("in.mdd"), "wb") as file:
            file.write(struct.pack(">ii%df" % self.FRAMES, self.FRAMES, self.VERTICES, *times))
            file.write(self.floats.astype(">f4").tobytes())
        convert(self.path("in.mdd"), "--base", self.path("base.obj"), "-o", self.path("run"))
        with open(self.path("run/frames.jsonl"), encoding="utf-8") as file:
            frames = [json.loads(line) for line in file]
        self.assertEqual([frame["time"] for frame in frames], times)
        positions = np.stack([np.load(self.path("run/" + frame["file"])) for frame in frames])
        self.assertTrue(same_bits(positions, self.floats))


class Vtk(Case):
    def read(self, name):
        from vtk.util.numpy_support import vtk_to_numpy
        import vtk

        source = vtk.vtkXMLPolyDataReader()
        self.assertTrue(source.CanReadFile(name))
        source.SetFileName(name)
        source.Update()
        self.assertEqual(source.GetErrorCode(), 0)
        data = source.GetOutput()
        polygons = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        return (
            vtk_to_numpy(data.GetPoints().GetData()),
            polygons.astype(np.int32),
            vtk_to_numpy(data.GetCellData().GetArray("group")),
        )

    def test_pvd(self):
        for name, positions in (("doubles & more.pvd", self.doubles), ("floats.pvd", self.floats)):
            convert(self.save(positions), "-o", self.path(name))
            entries = xml.etree.ElementTree.parse(self.path(name)).getroot().findall("Collection/DataSet")
            self.assertEqual([float(entry.get("timestep")) for entry in entries], list(range(self.FRAMES)))
            for i, entry in enumerate(entries):
                points, faces, group = self.read(self.path(entry.get("file")))
                self.assertTrue(same_bits(np.ascontiguousarray(points), positions[i]))
                self.assertTrue(same_bits(faces, self.faces))
                self.assertTrue(same_bits(np.ascontiguousarray(group), self.group))


class Blender(Case):
    def test_cache_is_played_and_exported(self):
        """Our PC2 through Blender's player and back through its exporters: the layouts are Blender's, not only ours."""
        rounded = np.ldexp(np.random.default_rng(1).uniform(-1, 1, self.doubles.shape), -3).astype(np.float32)
        convert(self.save(rounded.astype(np.float64)), "-o", self.path("cloth.pc2"))
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender_caches.py")
        arguments = [self.path("cloth.obj"), self.path("cloth.pc2"), str(self.FRAMES), self.path("played")]
        command = ["blender", "-b", "--factory-startup", "-noaudio", "-P", script, "--", *arguments]
        subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for name in ("played.pc2", "played.mdd"):
            convert(self.path(name), "--base", self.path("cloth.obj"), "-o", self.path(name + ".npz"))
            with np.load(self.path(name + ".npz")) as played:
                self.assertTrue(same_bits(played["V"], rounded), name)


    def test_cloth_that_blender_simulates_is_checked(self):
        """A fast ball goes through Blender's curtain: whatever is reported is confirmed in Python's rationals."""
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender_cloth.py")
        command = ["blender", "-b", "--factory-startup", "-noaudio", "-P", script, "--", self.path("sweep"), "30", "30"]
        subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        command = [program, "verify", self.path("sweep.pc2"), "--json", self.path("r.json"), "--max-violations", "100000"]
        self.assertEqual(subprocess.run(command, stdout=subprocess.PIPE).returncode, 1)
        with open(self.path("r.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual(report["frames"]["checked"], 30)
        self.assertEqual(report["surface"]["precision"], "float32")
        with open(self.path("sweep.pc2"), "rb") as file:
            vertices = struct.unpack("<12siiffi", file.read(32))[2]
            positions = np.frombuffer(file.read(), dtype="<f4").reshape(30, vertices, 3)
        counts = collections.Counter()
        for violation in report["violations"]:
            self.assertEqual((violation["event"], violation["kind"]), ("overlap", "cross"))
            corners = [[Fraction(float(x)) for x in positions[violation["frame"], v]] for v in violation["vertices"]]
            self.assertTrue(pierce(corners[:3], corners[3:]), violation)
            counts[violation["frame"]] += 1
        self.assertEqual(sum(counts.values()), report["violations_total"]["overlap"])
        self.assertNotIn(0, counts)
        print("intersecting pairs by frame:", dict(sorted(counts.items())))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], {"numpy": "NumPy", "vtk": "Vtk", "blender": "Blender"}[reader]])
