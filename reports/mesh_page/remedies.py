"""What to do about a mesh that is refused, in terms of the command's options."""

import lepp
from lepp import Remedy
from study.meshes.read import ReadOptions

_WORDS = {
    Remedy.SPLIT_QUADS: "--split-quads splits each into two triangles",
    Remedy.IGNORE_VOLUMES: (
        "only triangles in the plane or on a surface are taken; --ignore-volumes takes the "
        "triangles that the mesh also has"
    ),
    Remedy.MERGE_OR_KEEP: "--merge-points joins them, --keep-points leaves the mesh cut there",
    Remedy.LEAVE_OUT: "--drop-duplicates leaves them out",
}


def in_options(remedy: Remedy, options: ReadOptions) -> str:
    """Say what to do about a problem, beyond the options that were given."""
    if remedy is Remedy.MERGE_AND_LEAVE_OUT:
        if options.drop_duplicates:
            return "--merge-points joins the points, and then they can be left out"
        return "--merge-points joins the points, and --drop-duplicates then leaves them out"
    return _WORDS.get(remedy, remedy.value)


def refusal(error: lepp.MeshError, options: ReadOptions) -> lepp.InputError:
    """Return the error with its remedies in terms of the command's options."""
    return lepp.InputError(error.worded(lambda remedy: in_options(remedy, options)))
