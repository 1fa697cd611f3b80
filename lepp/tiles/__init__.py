"""Plain insertion of more points than fit into memory, tile by tile.

1. `lepp.tiles.coarse`: a few of the points are triangulated; the triangles are the tiles.
2. `lepp.tiles.location`: every point is sent to its tile.
3. `lepp.tiles.fine`: tiles are triangulated, each by itself.
4. `lepp.tiles.crossings`: each says what becomes of paths that enter it.
5. `lepp.tiles.joining`: so every tile can be told what lies beyond its sides.
6. `lepp.tiles.measuring`: tiles are triangulated again, and counted among what surrounds them.

The counts add up to those of the whole triangulation, number for number.
"""
