"""The edge of the mesh and its interior: where the mean comes from, and the longest paths."""

from reports.page.blocks import Section
from reports.page.evidence import Evidence
from reports.study_page.sections.layers import layers
from reports.study_page.sections.longest_paths import longest_paths
from reports.study_page.sections.parts import parts


def section(evidence: Evidence) -> Section:
    """Means of the parts, means of the layers, the layers of the longest paths."""
    return Section(
        "edge",
        "The edge and the inside",
        "Where in the mesh does the mean come from?",
        (parts(evidence), layers(evidence), longest_paths(evidence)),
    )
