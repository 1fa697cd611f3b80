"""The command ``lepp-study mesh``: a file in, answers out."""

import json
import sys
from pathlib import Path

import lepp
from reports.mesh_page.page import render
from reports.mesh_page.terminal import in_options, print_survey
from study.meshes.read import ReadOptions, read_mesh
from study.meshes.survey import Survey, as_json, survey
from study.meshes.write import check_not_same, check_output, write_mesh
from study.results.files import write_text

_STANDARD_OUTPUT = Path("-")


def answer(
    file: Path,
    options: ReadOptions,
    *,
    html: Path | None = None,
    json_file: Path | None = None,
    output: Path | None = None,
) -> list[str]:
    """Survey the mesh in a file and write the answers that are asked for.

    The text goes to the standard output, unless JSON does.

    Parameters
    ----------
    file : Path
    options : ReadOptions
    html, json_file, output : Path, optional
        Files to write; ``-`` as `json_file` is the standard output.

    Returns
    -------
    list of str
        What was written where, a line each.

    Raises
    ------
    lepp.InputError
        A mesh that cannot be surveyed, or an output that cannot be written.
    """
    _check_outputs(file, html, json_file, output)
    try:
        found = survey(read_mesh(file, options))
    except lepp.MeshError as error:
        raise in_options(error) from None
    written = []
    if json_file not in (None, _STANDARD_OUTPUT):
        write_text(json_file, _json_text(found))
        written.append(f"JSON: {json_file}")
    if output is not None:
        write_mesh(found, output)
        written.append(f"Mesh: {output}")
    if html is not None:
        write_text(html, render(found))
        written.append(f"Page: {html}")
    if json_file == _STANDARD_OUTPUT:  # last: a reader of a pipe may go away
        sys.stdout.write(_json_text(found))
    else:
        print_survey(found)
    return written


def _check_outputs(
    file: Path, html: Path | None, json_file: Path | None, output: Path | None
) -> None:
    """Refuse outputs that could not be written before any work is done."""
    names = [path for path in (html, json_file, output) if path not in (None, _STANDARD_OUTPUT)]
    for path in names:
        assert path is not None
        check_not_same(path, file)
    if len({path.resolve() for path in names if path}) < len(names):
        raise lepp.InputError("Two outputs have the same name: give each its own.")
    if output is not None:
        check_output(output, file)


def _json_text(found: Survey) -> str:
    return json.dumps(as_json(found), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
