"""Sentences of the page that have nothing to count, word for word, by the reason.

A sentence that changes by a word is no longer among them, and is reported.
"""

import re

#: A figure, which has the number of its place on the page: among the sentences it is Figure N.
FIGURE = re.compile(r"Figure \d+")

DEFINITIONS: dict[str, frozenset[str]] = {
    "what a word means, or a theorem supposes": frozenset(
        {
            "A neighbour is of type A, B or C when the crossed edge is its shortest, middle "
            "or longest.",
            "A path ends at a neighbour of type C: one whose own longest edge is the edge "
            "that is crossed.",
            "It ends at a terminal edge: the longest edge of both triangles beside it, or one "
            "on the boundary.",
            "Its bounds need less: if every step ends a path with a chance of at least 1/3, "
            "which may differ from step to step, then at most (2/3)ʲ of the paths go on for j "
            "steps after their second triangle, the mean is at most 2 + 2/3 + (2/3)² + … = 4, "
            "and the standard deviation at most √6, for no law of such chances varies more than "
            "that of 1/3 throughout.",
            "Its size is the number of triangles on it.",
            "No bound holds for all meshes: in a strip whose edges grow from one end to the "
            "other, the first triangle's path covers everything, and the mean is (n + 1) / 2.",
            "One path is the first step of a refinement: the triangles at its terminal edge "
            "are bisected, and the path is followed anew until the triangle it starts from "
            "has been bisected itself.",
            "That it is above 2 had to come out: a path in the interior has 2 triangles or "
            "more by definition.",
            "The interior is all triangles that are 30 or more steps across edges away from a "
            "triangle at the hull; the edge is all others.",
            "The layer of a triangle is its number of steps from the hull.",
            "The longest-edge propagation path (LEPP) of a triangle starts at the triangle "
            "and crosses its longest edge into the neighbour, then the neighbour’s longest "
            "edge, and so on.",
            "The lower one, 2, is the size of the shortest path inside.",
            "The models of growth do.",
            "The runs test counts whole numbers of runs, so that sets of a given size can "
            "have only certain p-values.",
            "The whole mesh and its interior have one limit, as long as the edge's share of the "
            "triangles falls faster than its mean grows.",
            "That is what the package makes that the paper names, CGAL's “2D Triangulation”.",
            "Theorem 1 takes the chance to end to be the same at every step, and makes all "
            "four moments out of it.",
            "Theorem 2 supposes p ≥ 1/3 and, with Theorem 1, the same p at every step.",
        }
    ),
    "how a figure is read": frozenset(
        {
            "A dot is one triangulation; it is drawn at its number of points.",
            "A line that rises says that long paths start at the edge.",
            "It ends where fewer than 100 paths are left.",
            "A square is the second group's mean less the first's, blue where it is larger "
            "and orange where it is smaller; a dot marks pairs that cannot be told apart.",
            "Above the whole mesh, below its interior, where there is one.",
            "At the left end are all triangles: there the share is that of the edge in the mesh.",
            "Bars are 95 % intervals of the means.",
            "Bars are 95 % intervals, mostly narrower than the markers.",
            "Bars are 95 % intervals, mostly narrower than the markers; the dotted line is "
            "the least share of type C that Theorem 2 supposes.",
            "Bars are 95 % intervals.",
            "Both methods triangulate the same points.",
            "Boxes span the quartiles, whiskers reach to 1.5 times their distance.",
            "Dots are means over triangulations with 95 % intervals.",
            "Dots are the means with 95 % intervals; curves are least squares fits to all "
            "sizes, of the paper's four models.",
            "Dots are the means with 95 % intervals; curves are weighted fits of the models "
            "that survive and of the paper's logarithmic one, to the sizes up to the upright "
            "line only, and go on beyond it; shaded is the 95 % interval of what a model that "
            "survives predicts there, which holds if the model does.",
            "Bars are 95 % intervals: narrow where regions are many, wide where they are few.",
            "Every edge across the strip is longer than the one to its left.",
            "If the points are random, the bars are level with the dashed line, give or take.",
            "Lines are 95 % intervals over triangulations of one number of points: the largest "
            "with 16 triangulations or more, if there is one.",
            "Long paths come in bundles that share most of their triangles: the longest one "
            "seen scatters more widely around what a law expects than independent paths "
            "would.",
            "Normal values would lie on the dashed line.",
            "Of the paths that have k triangles or more, the share that have more, with 95 % "
            "intervals, at the largest number of points with 16 triangulations or more: of "
            "fewer the covariance of the chances is not known.",
            "The first points of the first point set of each distribution, as drawn.",
            "The last dot is the interior: layer 30 and all beyond.",
            "The scales differ; what matters is the distance between the lines of a panel.",
            "All numbers of points are taken together.",
            "The vertical scale is logarithmic.",
            "The vertical scale is logarithmic: a geometric law is a straight line.",
            "Theorem 1 takes each line to be level.",
            "Theorem 1 takes it to be constant.",
            "Where the paper prints a mean, the lower panel has the difference; dotted lines "
            "are at 2 standard errors.",
            "With r of all steps the mean fits by construction.",
        }
    ),
    "not recounted: measured in another, far larger run, whose files are not those of the page": (
        frozenset(
            {
                "It starts there by measurement: at 10⁷ uniform points the means of layers 20 to "
                "23 of Delaunay meshes still are 3.55 to 3.50, and from layer 24 on those of the "
                "inside, 3.4764.",
            }
        )
    ),
    "what the page does, and why": frozenset(
        {
            "Figure N and Table 7 have it for the comparison with the paper; all else on this page "
            "goes by weighted fits, which do not suppose it.",
            "Figure N shows the means of all distributions.",
            "Delaunay triangulations are other meshes: that they differ is no failure to "
            "reproduce.",
            "The plain insertion method, the paper's, inserts the points as they come and never "
            "flips an edge; the Delaunay method makes triangles that are as far from thin as "
            "the points allow.",
            "The paper shows Table 4 for uniform points only; for the others it says that the "
            "results are alike.",
            "The paper's triangulations are made by inserting the points as they come, "
            "without flips (the plain insertion method).",
            "The report is made by software, from a design and a seed; cite both, and the paper.",
            "What follows is extrapolation, by the models that survive for the whole mesh; "
            "the intervals hold only if the model does.",
        }
    ),
}
