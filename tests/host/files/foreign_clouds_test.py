"""foreign_clouds_test.py DUMP [--fault]: clouds written by laspy, lazrs and libE57Format, as emax reads
them. DUMP is the program of dump_cloud.cpp. Coordinates are compared bit by bit with what these
libraries read. With --fault a bit of each expected coordinate is wrong, which must be seen."""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import laspy
import numpy as np
import pye57
from pye57 import libe57

DUMP, FAULT = sys.argv[1], "--fault" in sys.argv
COUNT = 5000
MOST_KILOBYTES = 1 << 20  # of memory for a damaged file
random = np.random.default_rng(20)
checks = 0


def dump(path, *options):
    done = subprocess.run(["bash", "-c", f"ulimit -v {MOST_KILOBYTES}; exec \"$@\"", "-", DUMP, *options[:0], str(path),
                           *map(str, options)], capture_output=True, timeout=120)
    return done.returncode, done.stdout, done.stderr.decode()


def read(path, *options):
    status, output, errors = dump(path, *options)
    if status != 0:
        raise SystemExit(f"{path}: {errors}")
    line, _, numbers = output.partition(b"\n")
    return json.loads(line), np.frombuffer(numbers, "<f8").reshape(-1, 3)


def expect(holds, what):
    global checks
    checks += 1
    if not holds:
        raise SystemExit(f"foreign clouds: {what}")


def expect_points(what, points, expected):
    expected = np.ascontiguousarray(expected, "<f8").reshape(-1, 3)
    if FAULT:
        expected = (expected.view("<u8") ^ np.uint64(1)).view("<f8")
    expect(points.shape == expected.shape, f"{what}: {points.shape[0]} points, not {expected.shape[0]}")
    expect(np.array_equal(points.view("<u8"), expected.view("<u8")), f"{what}: other coordinates")


def expect_refused(path, *wanted):
    status, output, errors = dump(path)
    text = f"{path}: exit {status}, {errors!r}"
    expect(status == 1 and not output and errors.count("\n") == 1, text)
    expect(errors.startswith(f"{path}: ") and "; " in errors, text)
    for word in wanted:
        expect(word in errors, f"{text}, without {word!r}")


def altered(path, name, at, new):
    data = bytearray(path.read_bytes())
    data[at:at + len(new)] = new
    other = path.with_name(name)
    other.write_bytes(data)
    return other


def cut(path, size):
    other = path.with_name(f"cut{size}{path.suffix}")
    other.write_bytes(path.read_bytes()[:size])
    return other


def las_of(version, format_id, extra=False, count=COUNT):
    header = laspy.LasHeader(version=version, point_format=format_id)
    header.scales = [0.001, 1e-5, 0.01]
    header.offsets = [400000.25, -5e6, 0.1]
    if extra:
        header.add_extra_dim(laspy.ExtraBytesParams(name="more", type="u2"))
    las = laspy.LasData(header)
    # A walk, as neighbours in a file are neighbours in space.
    for name in "XYZ":
        setattr(las, name, np.cumsum(random.integers(-1000, 1000, count)).astype(np.int32))
    las.X[count // 2] = 2**31 - 1
    las.Y[count // 3] = -2**31
    las.classification = random.integers(0, 4, count).astype(np.uint8)
    las.intensity = random.integers(0, 65535, count).astype(np.uint16)
    if extra:
        las.more = random.integers(0, 65535, count).astype(np.uint16)
    return las


def check_las(folder):
    versions = {"1.1": range(2), "1.2": range(4), "1.3": range(6), "1.4": range(11)}
    for version, formats in versions.items():
        for format_id in formats:
            for ending in (".las", ".laz"):
                las = las_of(version, format_id, extra=format_id % 2 == 0)
                path = folder / f"v{version}f{format_id}{ending}"
                las.write(path)
                again = laspy.read(path)
                told, points = read(path)
                expect_points(path.name, points, again.xyz)
                expect(told["left_out"] == "", f"{path}: points are left out")
                expect(math.isclose(told["resolution"], math.hypot(0.001, 1e-5, 0.01) / 2), f"{path}: {told}")
                told, points = read(path, 1, 3)
                classes = np.asarray(again.classification)
                expect_points(path.name, points, again.xyz[(classes != 1) & (classes != 3)])
                first = 1 if classes[classes % 2 == 1][0] == 1 else 3
                expect(told["left_out"].startswith(f"{np.sum(classes == first)} of class {first}, "), f"{path}: {told}")
                expect(told["last_index"] == np.flatnonzero(classes % 2 == 0)[-1], f"{path}: {told}")
    one_zero = folder / "one_zero.las"
    las_of("1.1", 1).write(one_zero)
    altered(one_zero, one_zero.name, 25, b"\0")
    expect_points("1.0", read(one_zero)[1], laspy.read(folder / "one_zero.las").xyz)

    # Withheld points, and the unit of well-known text.
    for version, format_id in (("1.2", 3), ("1.4", 7)):
        las = las_of(version, format_id)
        las.withheld = (np.arange(COUNT) % 3 == 0).astype(np.uint8)
        las.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(
            'PROJCS["UTM",GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]],UNIT["metre",1]]'))
        for ending in (".las", ".laz"):
            path = folder / f"withheld{version}{ending}"
            las.write(path)
            again = laspy.read(path)
            told, points = read(path)
            expect_points(path.name, points, again.xyz[np.asarray(again.withheld) == 0])
            expect(told["left_out"] == f"{(COUNT + 2) // 3} withheld", f"{path}: {told}")
            expect(told["unit"] == "m", f"{path}: {told}")

    # Chunks of any number of points, and many of them.
    header = laspy.LasHeader(version="1.4", point_format=7)
    header.scales = [0.001] * 3
    for ending, name in ((".laz", "many_chunks"),):
        las = las_of("1.4", 7, count=120000)
        path = folder / (name + ending)
        las.write(path)
        expect_points(name, read(path)[1], laspy.read(path).xyz)


def check_damaged_las(folder):
    las, laz = folder / "v1.4f6.las", folder / "v1.4f6.laz"
    old = folder / "v1.2f3.laz"
    size, small = las.stat().st_size, laz.stat().st_size
    expect_refused(cut(las, 100), "header", "copy or export it again")
    expect_refused(cut(las, size - 1), "promises 5000 points")
    expect_refused(cut(laz, small - 1), "copy or export it again")
    expect_refused(cut(laz, small // 2), "copy or export it again")
    expect_refused(cut(old, old.stat().st_size // 2), "copy or export it again")
    expect_refused(altered(las, "count.las", 247, b"\xff" * 8), "points")
    expect_refused(altered(laz, "count.laz", 247, b"\xff\xff\xff\xff\0\0\0\0"), "points")
    expect_refused(altered(las, "zero.las", 247, bytes(8)), "promises 0 points, but the file has 5000")
    expect_refused(altered(laz, "zero.laz", 247, bytes(8)), "no points")
    expect_refused(altered(las, "version.las", 25, b"\x07"), "version 1.7")
    expect_refused(altered(las, "scale.las", 131, bytes(8)), "scale factor")
    expect_refused(altered(las, "nan.las", 155, b"\xff" * 8), "offset is not finite")
    expect_refused(altered(las, "format.las", 104, b"\x0b"), "point format 11")
    expect_refused(altered(las, "record.las", 105, b"\x05\0"), "5 bytes are too few")
    expect_refused(altered(las, "records.las", 100, b"\xff" * 4), "records")
    expect_refused(altered(las, "offset.las", 96, b"\xff" * 4), "at byte 4294967295")
    expect_refused(altered(laz, "renamed.las", 0, b"LASF"), "content is that of a .laz file", "rename it to .laz")
    expect_refused(altered(las, "renamed.laz", 0, b"LASF"), "rename it to .las")
    expect_refused(altered(las, "las.xyz", 0, b"LASF"), "rename it to .las")
    # The table of chunks: its place is at the begin of the points, the number of chunks behind a version.
    for path in (laz, old):
        data = path.read_bytes()
        begin = int.from_bytes(data[96:100], "little")
        table = int.from_bytes(data[begin:begin + 8], "little")
        expect_refused(altered(path, "chunks.laz", table + 4, b"\xff" * 4), "promises 4294967295 chunks")
        expect_refused(altered(path, "table.laz", begin, b"\xff\xff\xff\x7f" + bytes(4)), "table of its compressed chunks")
    data = laz.read_bytes()
    begin = int.from_bytes(data[96:100], "little") + 8
    expect_refused(altered(laz, "layer.laz", begin + 32 + 4, b"\xff" * 4), "layers of compressed chunk 0")
    # Every damaged byte of the points ends in a line or in other points, never in a crash.
    refused = 0
    for at in random.integers(begin, small, 60):
        path = altered(old if at % 2 else laz, "damaged.laz", min(at, old.stat().st_size - 1) if at % 2 else at, b"\xaa\x55")
        status, _, errors = dump(path)
        expect(status in (0, 1) and errors.count("\n") == status, f"damaged at {at}: {status} {errors}")
        refused += status
    expect(refused > 30, f"only {refused} of 60 damaged files are refused")


def float_node(image, single=False):
    return libe57.FloatNode(image, 0.0, libe57.FloatPrecision.E57_SINGLE if single else libe57.FloatPrecision.E57_DOUBLE)


def write_e57(path, scans):
    """Each scan: name, {field: (node of the image, values)}, rotation (w x y z) or None, translation."""
    e57 = pye57.E57(str(path), mode="w")
    image = e57.image_file
    for name, fields, rotation, translation in scans:
        node = libe57.StructureNode(image)
        node.set("guid", libe57.StringNode(image, "{%s}" % name))
        if name:
            node.set("name", libe57.StringNode(image, name))
        if rotation is not None:
            pose, turn, shift = (libe57.StructureNode(image) for _ in range(3))
            for axis, value in zip("wxyz", rotation):
                turn.set(axis, libe57.FloatNode(image, value))
            for axis, value in zip("xyz", translation):
                shift.set(axis, libe57.FloatNode(image, value))
            pose.set("rotation", turn)
            pose.set("translation", shift)
            node.set("pose", pose)
        prototype = libe57.StructureNode(image)
        buffers, count = libe57.VectorSourceDestBuffer(), 0
        keep = []
        for field, (make, values) in fields.items():
            prototype.set(field, make(image))
            values = np.ascontiguousarray(values)
            keep.append(values)
            count = len(values)
            buffers.append(libe57.SourceDestBuffer(image, field, values, count, True, True))
        points = libe57.CompressedVectorNode(image, prototype, libe57.VectorNode(image, True))
        node.set("points", points)
        e57.data3d.append(node)
        writer = points.writer(buffers)
        writer.write(count)
        writer.close()
    e57.close()


def fields_of(names, make, values):
    return {name: (make, values[:, k].copy()) for k, name in enumerate(names)}


CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")


def posed(points, rotation, translation):
    """In the order of operations that emax documents, each rounded to 64 bits."""
    n = math.sqrt(sum(q * q for q in rotation[:1]) + rotation[1] ** 2 + rotation[2] ** 2 + rotation[3] ** 2)
    w, x, y, z = (q / n for q in rotation)
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return np.stack([((r[k][0] * points[:, 0] + r[k][1] * points[:, 1]) + r[k][2] * points[:, 2]) + translation[k]
                     for k in range(3)], axis=1)


def check_e57(folder):
    double = lambda image: float_node(image)
    single = lambda image: float_node(image, True)
    scaled = lambda image: libe57.ScaledIntegerNode(image, 0, -2**30, 2**30, 1e-4, 12.5)
    state = lambda image: libe57.IntegerNode(image, 0, 0, 2)
    intensity = lambda image: libe57.IntegerNode(image, 0, 0, 255)
    points = random.normal(scale=20, size=(COUNT, 3)) + [1e6, -2e6, 100]
    near = random.normal(scale=20, size=(COUNT, 3))
    ones = random.integers(0, 255, COUNT).astype(np.uint8)

    def raw(path, index, names=CARTESIAN):
        data = pye57.E57(str(path)).read_scan_raw(index)
        return np.stack([data[name] for name in names], axis=1).astype("<f8")

    for name, make, values in (("double", double, points), ("single", single, near), ("scaled", scaled, near)):
        path = folder / f"{name}.e57"
        write_e57(path, [(name, {**fields_of(CARTESIAN, make, values), "intensity": (intensity, ones)}, None, None)])
        told, got = read(path)
        expect_points(name, got, raw(path, 0))
        expect(told["unit"] == "m" and told["scans"] == [[name, 0]], f"{path}: {told}")
        step = {"double": 0, "single": np.linalg.norm(np.abs(got).max(axis=0)) * 2**-24, "scaled": 0.5e-4 * math.sqrt(3)}
        expect(math.isclose(told["resolution"], step[name]), f"{path}: {told}")

    half = math.sqrt(0.5)
    poses = [((half, 0, half, 0), (1e5, 2.5, -3)), ((0.5, 0.5, -0.5, 0.5), (0, 0, 0)),
             ((0.9, 0.1, math.sqrt(1 - 0.81 - 0.01 - 0.04), 0.2), (-7, 1e-3, 4))]
    states = random.integers(0, 3, COUNT).astype(np.uint8)
    scans = [(f"station {i}", {**fields_of(CARTESIAN, double, near + i), "cartesianInvalidState": (state, states)}, *pose)
             for i, pose in enumerate(poses)]
    path = folder / "stations.e57"
    write_e57(path, scans)
    valid = states == 0
    told, got = read(path)
    expect_points("stations", got, np.concatenate([posed((near + i)[valid], *pose) for i, pose in enumerate(poses)]))
    begin = int(valid.sum())
    expect(told["scans"] == [[f"station {i}", i * begin] for i in range(3)], f"{path}: {told}")
    for count, why in ((np.sum(states == 1), "only directions"), (np.sum(states == 2), "marked as invalid")):
        expect(f"{3 * count} {why}" in told["left_out"], f"{path}: {told}")
    expect(told["last_index"] == 2 * COUNT + np.flatnonzero(valid)[-1], f"{path}: {told}")
    # pye57 computes the pose in another order.
    theirs = np.concatenate([pye57.E57(str(path)).to_global((near + i)[valid], np.array(q), np.array(t))
                             for i, (q, t) in enumerate(poses)])
    expect(np.abs(theirs - got).max() < 1e-10, "stations: pye57 puts the points elsewhere")

    polar = np.stack([random.uniform(1, 50, COUNT), random.uniform(-3.1, 3.1, COUNT), random.uniform(-1.5, 1.5, COUNT)], 1)
    path = folder / "spherical.e57"
    write_e57(path, [("", {**fields_of(SPHERICAL, double, polar), "sphericalInvalidState": (state, states)}, None, None)])
    told, got = read(path)
    r, a, e = polar[valid].T
    flat = r * np.array([math.cos(v) for v in e])
    expected = np.stack([flat * [math.cos(v) for v in a], flat * [math.sin(v) for v in a],
                         r * [math.sin(v) for v in e]], axis=1)
    expect_points("spherical", got, expected)
    theirs = pye57.E57(str(path)).read_scan(0, ignore_missing_fields=True)
    theirs = np.stack([theirs[name] for name in CARTESIAN], axis=1)
    expect(np.abs(theirs - got).max() < 1e-12, "spherical: pye57 puts the points elsewhere")

    # More than one packet and page, and fields of few bits.
    many = random.normal(size=(300000, 3))
    path = folder / "many.e57"
    write_e57(path, [("many", {**fields_of(CARTESIAN, scaled, many),
                               "cartesianInvalidState": (state, np.zeros(len(many), np.uint8))}, None, None)])
    expect_points("many", read(path)[1], raw(path, 0))

    for name, rotation in (("stretched", (1.1, 0, 0, 0)), ("nothing", (0, 0, 0, 0))):
        path = folder / f"{name}.e57"
        write_e57(path, [(name, fields_of(CARTESIAN, double, near), rotation, (0, 0, 0))])
        expect_refused(path, f'the pose of scan "{name}" is not a rotation', "rigid poses")
    path = folder / "not_finite.e57"
    near[7, 1] = math.nan
    write_e57(path, [("x", fields_of(CARTESIAN, double, near), None, None)])
    expect_refused(path, "point 7: a coordinate is NaN", "--skip-invalid")
    all_invalid = {**fields_of(CARTESIAN, double, points), "cartesianInvalidState": (state, states * 0 + 2)}
    write_e57(folder / "invalid.e57", [("x", all_invalid, None, None)])
    expect_refused(folder / "invalid.e57", "every point is left out: 5000 marked as invalid")
    e57 = pye57.E57(str(folder / "empty.e57"), mode="w")
    e57.close()
    expect_refused(folder / "empty.e57", "no points")


def check_damaged_e57(folder):
    path = folder / "double.e57"
    size = path.stat().st_size
    data = path.read_bytes()
    expect_refused(altered(path, "page.e57", 2000, bytes([data[2000] ^ 1])), "the checksum of page 1 is wrong")
    expect_refused(altered(path, "xml.e57", size - 2000, b"\xff"), "checksum of page")
    expect_refused(cut(path, size - 1024), f"promises {size} bytes")
    expect_refused(cut(path, 30), "ends before")
    expect_refused(cut(path, 1000), "promises")
    expect_refused(altered(path, "xml_size.e57", 32, b"\xff" * 8), "bytes of XML")
    expect_refused(altered(path, "xml_place.e57", 24, b"\xff" * 8), "export it again")
    expect_refused(altered(path, "version.e57", 8, b"\x09"), "version")
    expect_refused(altered(path, "e57.ply", 0, b"A"), "rename it to .e57")
    (folder / "text.e57").write_text("1 2 3\n4 5 6\n")
    expect_refused(folder / "text.e57", "ends before")
    (folder / "long.e57").write_text("1 2 3\n" * 1000)
    expect_refused(folder / "long.e57", "does not begin as an E57 file")
    # A false count in the XML, with a true checksum.
    data = bytearray(path.read_bytes())
    place = data.index(b'recordCount="5000"')
    data[place:place + 18] = b'recordCount="9000"'
    reseal(data, place)
    (folder / "count.e57").write_bytes(data)
    expect_refused(folder / "count.e57", "promises 9000 points")


def reseal(data, place):
    """Sets the checksum (CRC-32C) of the page around `place`, as of one byte before or after its end."""
    for page in {place // 1024, (place + 18) // 1024}:
        crc = 0xFFFFFFFF
        for byte in data[1024 * page:1024 * page + 1020]:
            crc ^= byte
            for _ in range(8):
                crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
        data[1024 * page + 1020:1024 * page + 1024] = (crc ^ 0xFFFFFFFF).to_bytes(4, "big")


def main():
    with tempfile.TemporaryDirectory(prefix="emax_clouds_") as name:
        folder = Path(name)
        check_las(folder)
        check_damaged_las(folder)
        check_e57(folder)
        check_damaged_e57(folder)
    print(f"foreign clouds: {checks} checks hold")


main()
