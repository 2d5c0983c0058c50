"""Reports for the test of the page: a noisy sphere and a mesh of few triangles, as host/report/page/README.md says."""

import base64
import json
import math
import struct
import zlib
from array import array

MARKER = "<!--emax:report-->"
RADIUS, CENTRE, EPSILON = 50.0, (10.0, -20.0, 30.0), 0.8
HISTOGRAM_BINS = 40
# From blue by way of grey to red; not the colours of the program, so that the page has to take these.
COLOURS = {"stops": [[20 + 50 * k, 60 + 40 * k, 220] for k in range(4)] + [[222, 220, 214]] + [[220, 180 - 40 * k, 170 - 50 * k] for k in range(4)],
           "above": [250, 180, 10], "below": [170, 80, 230]}
# A picture of one grey pixel.
PICTURE = ("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNsaGj4DwAFhAKAjM1mJgAAAABJRU5ErkJggg==")


def sphere_mesh(rings, sectors):
    """(vertices, triangles) of a sphere around CENTRE, oriented outward."""
    place = lambda theta, phi: tuple(c + RADIUS * d for c, d in zip(CENTRE, (
        math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))))
    vertices = [place(0, 0)]
    for ring in range(1, rings):
        vertices += [place(math.pi * ring / rings, 2 * math.pi * s / sectors) for s in range(sectors)]
    vertices.append(place(math.pi, 0))
    last, triangles = len(vertices) - 1, []
    at = lambda ring, s: 1 + (ring - 1) * sectors + s % sectors
    for s in range(sectors):
        triangles.append((0, at(1, s), at(1, s + 1)))
        triangles.append((last, at(rings - 1, s + 1), at(rings - 1, s)))
        for ring in range(1, rings - 1):
            triangles.append((at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)))
            triangles.append((at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)))
    return vertices, triangles


def sphere_points(count):
    """[(position, deviation)] on a spiral; the deviation is a wave of amplitude 0.9 ε, and one point lies at 1.25 ε."""
    points, golden = [], math.pi * (3 - math.sqrt(5))
    for i in range(count):
        z = 1 - 2 * (i + 0.5) / count
        r, phi = math.sqrt(1 - z * z), golden * i
        deviation = 0.9 * EPSILON * math.sin(3 * math.asin(z)) * math.cos(2 * phi) if i != count // 3 else 1.25 * EPSILON
        points.append((tuple(c + (RADIUS + deviation) * d for c, d in zip(CENTRE, (
            r * math.cos(phi), r * math.sin(phi), z))), deviation))
    return points


def little(code, values):
    numbers = array(code, values)
    if struct.pack("=H", 1) != struct.pack("<H", 1):
        numbers.byteswap()
    return numbers.tobytes()


def geometry_of(points, vertices, triangles, signed):
    """(bytes, shape)"""
    low = [min(p[0][a] for p in points) for a in range(3)]
    high = [max(p[0][a] for p in points) for a in range(3)]
    step = [(h - l) / 65535 for l, h in zip(low, high)]
    deviation_step = max(abs(d) for _, d in points) / 32767
    columns = [little("H", [round((p[0][a] - low[a]) / step[a]) for p in points]) for a in range(3)]
    deviations = little("h", [round((d if signed else abs(d)) / deviation_step) for _, d in points])
    mesh = b"".join(little("f", [v[a] - low[a] for v in vertices]) for a in range(3))
    # Of each triangle the deviation on the sphere's wave at its centre; one is nearest to no point.
    of_triangle = []
    for t in triangles:
        centre = [sum(vertices[i][a] for i in t) / 3 - CENTRE[a] for a in range(3)]
        z = max(-1, min(1, centre[2] / math.sqrt(sum(c * c for c in centre))))
        wave = 0.9 * EPSILON * math.sin(3 * math.asin(z)) * math.cos(2 * math.atan2(centre[1], centre[0]))
        of_triangle.append(wave if signed else abs(wave))
    of_triangle[-1] = float("nan")
    data = b"".join(columns) + deviations + mesh + little("I", [i for t in triangles for i in t]) + little("f", of_triangle)
    shape = {"points": len(points), "points_of": len(points), "vertices": len(vertices), "triangles": len(triangles),
             "origin": low, "step": step, "deviation_step": deviation_step, "up": [0, 0, 1]}
    return data, shape


def statistics_of(deviations, signed):
    n = len(deviations)
    mean = sum(deviations) / n
    sigma = math.sqrt(sum((d - mean) ** 2 for d in deviations) / n)
    return {"count": n, "min": min(deviations), "max": max(deviations), "mean": mean,
            "rms": math.sqrt(sum(d * d for d in deviations) / n), "sigma": sigma,
            "within_sigma": [sum(abs(d - mean) <= k * sigma for d in deviations) / n for k in (1, 2, 3)],
            "above": sum(d > EPSILON for d in deviations), "within": sum(abs(d) <= EPSILON for d in deviations),
            "below": sum(d < -EPSILON for d in deviations) if signed else 0}


def histogram_of(deviations, signed):
    low = -EPSILON if signed else 0.0
    edges = [low + (EPSILON - low) * i / HISTOGRAM_BINS for i in range(HISTOGRAM_BINS + 1)]
    counts = [0] * HISTOGRAM_BINS
    for d in deviations:
        if low <= d <= EPSILON:
            counts[min(HISTOGRAM_BINS - 1, int((d - low) / (EPSILON - low) * HISTOGRAM_BINS))] += 1
    return {"edges": edges, "counts": counts, "below": sum(d < low for d in deviations),
            "above": sum(d > EPSILON for d in deviations)}


def sphere_report(count=20_000, signed=True):
    """(data, geometry's bytes)"""
    points = sphere_points(count)
    vertices, triangles = sphere_mesh(12, 20)
    geometry, shape = geometry_of(points, vertices, triangles, signed)
    deviations = [d if signed else abs(d) for _, d in points]
    e_max = max(abs(d) for d in deviations)
    worst = sorted(range(count), key=lambda i: -abs(deviations[i]))[:20]
    certificate = json.dumps({"schema": "emax-certificate-3", "e_max": e_max, "bound": EPSILON,
                              "mesh": {"file": "part.ply", "sha256": "ab" * 32}}, indent=2)
    data = {
        "schema": "emax-report-1", "command": "optimize", "program": "emax 0.4.0", "title": "part.ply", "unit": "mm",
        "verdict": {"within": False, "text": "Exceeds the tolerance: 1 of 20,000 points is farther than 0.8 mm from the mesh"},
        "epsilon": EPSILON, "e_max": e_max, "back": 0.7912345, "width": 101.6, "triangles": len(triangles), "points": count,
        "facts": [{"name": "mesh", "text": f"{len(triangles)} triangles; valid: manifold, consistently oriented, free of self-intersections"},
                  {"name": "topology", "text": "1 component, closed, genus 0, like the reference"},
                  {"name": "device cpu", "text": "avx512 instructions in 0.008 s"}],
        "provenance": [{"name": "cloud", "file": "scan.ply", "sha256": "3f" * 32}, {"name": "mesh", "file": "part.ply", "sha256": "ab" * 32}],
        "parameters": [{"name": "method", "text": "gp3"}, {"name": "seed", "text": "1"}],
        "certificate": {"file": "part.ply.certificate.json", "text": certificate, "verify": "emax verify part.ply.certificate.json"},
        "checks": None, "signed": signed, "colours": COLOURS, "statistics": statistics_of(deviations, signed), "histogram": histogram_of(deviations, signed),
        "worst": [{"point": i, "position": points[i][0], "deviation": deviations[i], "triangle": i % len(triangles)} for i in worst],
        "excluded": [{"point": 7, "position": [CENTRE[0], CENTRE[1], CENTRE[2] + 70.0], "deviation": 20.0}], "excluded_count": 1,
        "left_out": [{"reason": "not finite", "points": 3}, {"reason": "of class 7", "points": 755}],
        "search": {"evaluations": [{"index": i, "seconds": 2.5 * i + 1, "triangles": round(440 + 9000 / (1 + i) + 700 * (i % 3)),
                                    "feasible": i % 4 != 1} for i in range(24)]},
        "curve": [{"epsilon": 0.1 * k, "triangles": round(4000 / k)} for k in range(1, 13)],
        "times": [{"name": "reading", "seconds": 0.4}, {"name": "reconstruction", "seconds": 12.7}, {"name": "decimation", "seconds": 61.0},
                  {"name": "certificate", "seconds": 3.1}],
        "geometry": shape}
    return data, geometry


def page_of(template, data, geometry):
    """The template with a report in it. data: an object or text; geometry: bytes, or the base64 text itself."""
    text = data if isinstance(data, str) else json.dumps(data)
    coded = geometry if isinstance(geometry, str) else base64.b64encode(zlib.compress(geometry)).decode()
    elements = (f'<script type="application/json" id="emax-data">{text.replace("<", chr(92) + "u003c")}</script>'
                f'<script type="application/octet-stream" id="emax-geometry">{coded}</script>'
                f'<img id="emax-picture" alt="The mesh" src="data:image/png;base64,{PICTURE}">')
    assert template.count(MARKER) == 1
    return template.replace(MARKER, elements)
