"""What a path is: three sentences, and a small triangulation to try it on."""

from reports.page.blocks import Drawing, Section, Subsection, TableBlock, common, per_view
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.explorer import EXPLORER_POINTS, EXPLORER_TRIANGLES, N_POINTS
from study.text.numbers import count, show


def section(evidence: Evidence) -> Section:
    """Three sentences and the explorer."""
    return Section(
        "path",
        "What a LEPP is",
        "What is studied?",
        (
            Subsection(
                "path-words",
                "",
                (
                    common(
                        "The longest-edge propagation path (LEPP) of a triangle starts at the "
                        "triangle and crosses its longest edge into the neighbour, then the "
                        "neighbour’s longest edge, and so on. It ends at a terminal edge: the "
                        "longest edge of both triangles beside it, or one on the boundary. Its "
                        "size is the number of triangles on it.",
                        "One path is the first step of a refinement: the triangles at its terminal "
                        "edge are bisected, and the path is followed anew until the triangle it "
                        "starts from has been bisected itself.",
                    ),
                ),
            ),
            Subsection("try", "Try it on a small triangulation", (_explorer(evidence),)),
        ),
    )


def _explorer(evidence: Evidence) -> Drawing:
    def say(view: View) -> str:
        triangles = evidence.rows(EXPLORER_TRIANGLES, view)
        sizes = triangles["lepp_size"]
        edges = triangles.frame[["terminal_a", "terminal_b"]].drop_duplicates()
        return (
            f"{len(triangles)} triangles of {N_POINTS} {view.distribution_word} points by the "
            f"{view.method_word} method. Their paths are {show(sizes.mean(), 'fixed2')} triangles "
            f"long on average and {sizes.max()} at most, and end at "
            f"{count(len(edges), 'terminal edge')}."
        )

    return Drawing(
        id="figure-path",
        template="explorer.html.j2",
        context={},
        title="The longest-edge propagation path of any triangle",
        alternatives=per_view(evidence.views, say),
        reading="",
        data=(
            TableBlock(EXPLORER_TRIANGLES, "the triangles and their paths"),
            TableBlock(EXPLORER_POINTS, "the points"),
        ),
        paper="Figure 1",
    )
