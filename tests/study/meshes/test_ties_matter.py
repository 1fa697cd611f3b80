"""Nearly equal edges beside exactly equal ones."""

import numpy as np

import lepp
from study.meshes.read import read_mesh
from study.meshes.survey import survey


def test_a_nearly_equal_third_edge_is_seen_beside_two_equal_ones(tmp_path):
    n = 20
    lower = [(2.0 * k, 0.0) for k in range(n + 1)]
    upper = [(2.0 * k + 1.0, 1.7320509) for k in range(n)]
    first = [(k, k + 1, n + 1 + k) for k in range(n)]
    second = [(k + 1, n + 2 + k, n + 1 + k) for k in range(n - 1)]
    points, triangles = np.array(lower + upper), np.array(first + second)
    file = tmp_path / "strip.off"
    rows = [" ".join(map(str, (*p, 0.0))) for p in points.tolist()]
    rows += [" ".join(map(str, (3, *t))) for t in triangles.tolist()]
    file.write_text("\n".join(["OFF", f"{len(points)} {len(triangles)} 0", *rows]) + "\n")
    surveyed = survey(read_mesh(file))
    assert surveyed.paths.n_nearly_equal == surveyed.paths.n_equal == len(triangles)
    mesh = lepp.Triangulation.from_arrays(points, triangles)
    equal = lepp.lepp_sizes(mesh, equal_within=lepp.NEARLY_EQUAL)
    assert surveyed.mean_if_equal == equal.mean() == 1.0
    assert surveyed.counts.mean > 1.5
    assert surveyed.ties_matter
