"""A scan for tests that run the programs."""
import math


def write_scan(path, points, generator):
    """Points of a sphere with bumps, drawn by the generator, as XYZ."""
    with open(path, "w") as scan:
        for _ in range(points):
            z = generator.uniform(-1, 1)
            turn = generator.uniform(0, 2 * math.pi)
            bump = 1 + 0.1 * z * math.sin(4 * turn)
            r = bump * math.sqrt(1 - z * z)
            print(r * math.cos(turn), r * math.sin(turn), bump * z, file=scan)
