"""The command ``lepp-study mesh``: what one refinement of a mesh in a file would spread to."""

from __future__ import annotations

from pathlib import Path

import click


class MeshCommand(click.Command):
    """A command that takes ``--json=OUT`` for ``--json-file OUT``.

    An option whose value may be left out would take the mesh's name for it.
    """

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse what follows the command's name."""
        end = args.index("--") if "--" in args else len(args)
        named = [
            f"--json-file={argument.removeprefix('--json=')}"
            if argument.startswith("--json=")
            else argument
            for argument in args[:end]
        ]
        return super().parse_args(ctx, named + args[end:])


@click.command(cls=MeshCommand)
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--html",
    metavar="OUT",
    type=click.Path(path_type=Path),
    help="Write a page with the mesh drawn.",
)
@click.option("--json", "print_json", is_flag=True, help="Print the numbers as JSON, not as text.")
@click.option(
    "--json-file",
    metavar="OUT",
    type=click.Path(path_type=Path),
    help="Write the numbers as JSON into a file; --json=OUT does the same.",
)
@click.option(
    "--output",
    metavar="OUT",
    type=click.Path(path_type=Path),
    help="Write the mesh with its paths as data of the cells (.vtu, .vtk, .xdmf or .msh).",
)
@click.option(
    "--equal-within",
    metavar="W",
    type=float,
    default=0.0,
    show_default=True,
    help="Take lengths of edges for equal that differ by at most this share: 1e-6 where "
    "coordinates are rounded to single precision.",
)
@click.option("--split-quads", is_flag=True, help="Split each quad into two triangles.")
@click.option(
    "--merge-points/--keep-points",
    default=None,
    help="Join points with the same coordinates, or leave the mesh cut there.",
)
@click.option(
    "--merge-within",
    metavar="TOL",
    type=float,
    help="Join points that are at most this share of the mesh's extent apart.",
)
@click.option(
    "--drop-duplicates",
    is_flag=True,
    help="Leave out triangles that repeat another or have the same point twice.",
)
@click.option(
    "--ignore-volumes", is_flag=True, help="Take the triangles of a mesh that has tetrahedra too."
)
@click.option(
    "--read-limit",
    metavar="SECONDS",
    type=click.FloatRange(min=1.0),
    help="Processor time that reading FILE may take; 15 s and 10 s a megabyte if not given.",
)
def mesh(
    file: Path,
    html: Path | None,
    print_json: bool,
    json_file: Path | None,
    output: Path | None,
    equal_within: float,
    split_quads: bool,
    merge_points: bool | None,
    merge_within: float | None,
    drop_duplicates: bool,
    ignore_volumes: bool,
    read_limit: float | None,
) -> None:
    """Say how far one refinement of the mesh in FILE spreads.

    FILE is a mesh of triangles in any format that meshio reads: VTK, VTU, Gmsh, OBJ, PLY, STL, OFF,
    Medit, Abaqus, XDMF and more; in the plane, or a surface in space.
    """
    from lepp import InputError
    from reports.mesh_page.command import Outputs, survey_file
    from study.meshes.read import ReadOptions

    if merge_within is not None and merge_points is False:
        raise InputError("Give --merge-within or --keep-points, not both.")
    options = ReadOptions(
        split_quads=split_quads,
        ignore_volumes=ignore_volumes,
        drop_duplicates=drop_duplicates,
        repeated_points="refuse" if merge_points is None else "merge" if merge_points else "keep",
        merge_within=merge_within,
        read_limit=read_limit,
    )
    outputs = Outputs(print_json=print_json, html=html, json_file=json_file, mesh=output)
    for line in survey_file(file, options, outputs, equal_within=equal_within):
        click.echo(line, err=print_json)
