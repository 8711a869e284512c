"""Small models with crooked outlines, whose cells and full meshes solvers compare."""

import math


def ring(n, axis_inside=False):
    """A star of n points with a bore or without: planar; outline marker 2, bore 1, region 7."""
    vertices, segments = [], []
    for radius, marker, wave in ((2.0, 2, 0.15),) + (() if axis_inside else ((1.0, 1, 0.0),)):
        first, count = len(vertices), 2 * n
        for i in range(count):
            r = radius * (1 + (wave if i % 2 == 0 else 0))
            t = 2 * math.pi * i / count
            vertices.append([r * math.cos(t), r * math.sin(t)])
        segments += [[first + i, first + (i + 1) % count, marker] for i in range(count)]
    return {"type": "pslg", "vertices": vertices, "segments": segments,
            "holes": [] if axis_inside else [[0, 0]],
            "regions": [{"point": [1.6, 0], "attribute": 7}]}


def prism(n, axis_inside=False, place=lambda p: p):
    """The star as a solid of two layers with a facet between: outline marker 2, bore 1, bottom 3,
    top 4, between 5; regions 1 and 2. `place`: moves points rigidly."""
    vertices, facets = [], []
    heights = (0.0, 0.4, 0.9)
    count = 2 * n
    loops = {}
    radii = {"outline": (2.0, 0.15)} if axis_inside else {"outline": (2.0, 0.15), "bore": (1.0, 0.0)}
    for name, (radius, wave) in radii.items():
        for level, z in enumerate(heights):
            first = len(vertices)
            for i in range(count):
                r = radius * (1 + (wave if i % 2 == 0 else 0))
                t = 2 * math.pi * i / count
                vertices.append(list(place((r * math.cos(t), r * math.sin(t), z))))
            loops[name, level] = list(range(first, first + count))
    for name, marker in (("outline", 2), ("bore", 1)):
        for level in range(2 if name in radii else 0):
            low, high = loops[name, level], loops[name, level + 1]
            for i in range(count):
                j = (i + 1) % count
                facets.append({"polygons": [[low[i], low[j], high[j], high[i]]], "marker": marker})
    for level, marker in ((0, 3), (1, 5), (2, 4)):
        facets.append({"polygons": [loops[name, level] for name in radii],
                       "holes": [] if axis_inside else [list(place((0, 0, heights[level])))],
                       "marker": marker})
    regions = [{"point": list(place((1.6, 0.0, z))), "attribute": k}
               for k, z in ((1, 0.2), (2, 0.65))]
    return {"type": "plc", "vertices": vertices, "facets": facets, "holes": [], "regions": regions}


def interlocked(n):
    """n pieces, each beneath the end of the one before, which it touches along a cylinder: the
    shortest bound has nodes of one radius and height. Outer side 2, inner 1, bottom 3, top 4."""
    pitch = 2 * math.pi / n
    outer = ((2.0, 0.5), (2.0, 0.79), (2.0, 1.08), (1.5, 1.08), (1.5, 1.29))
    inner = ((1.0, 0.0), (1.0, 0.3), (1.0, 0.6), (1.0, 0.9), (1.5, 0.9), (1.5, 1.0))
    vertices, facets, loops = [], [], {}
    for name, corners in (("outer", outer), ("inner", inner)):
        for z in (0.0, 0.3):
            first = len(vertices)
            vertices += [[r * math.cos((t + k) * pitch), r * math.sin((t + k) * pitch), z]
                         for k in range(n) for r, t in corners]
            loops[name, z] = list(range(first, len(vertices)))
    for name, marker in (("outer", 2), ("inner", 1)):
        low, high = loops[name, 0.0], loops[name, 0.3]
        for i in range(len(low)):
            j = (i + 1) % len(low)
            facets.append({"polygons": [[low[i], low[j], high[j], high[i]]], "marker": marker})
    for z, marker in ((0.0, 3), (0.3, 4)):
        facets.append({"polygons": [loops["outer", z], loops["inner", z]], "holes": [[0, 0, z]],
                       "marker": marker})
    return {"type": "plc", "vertices": vertices, "facets": facets, "holes": [], "regions": []}


def tilted(point):
    """A rigid motion that leaves no axis of the model along one of space, off the origin."""
    x, y, z = point
    c, s = math.cos(0.7), math.sin(0.7)
    y, z = c * y - s * z, s * y + c * z
    c, s = math.cos(0.4), math.sin(0.4)
    x, z = c * x + s * z, -s * x + c * z
    return x + 5.0, y - 3.0, z + 1.0
