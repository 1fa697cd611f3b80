"""The command ``lepp-study mesh``: a file in, its survey out."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import lepp
from reports.mesh_page import findings
from reports.mesh_page.console import print_survey
from reports.mesh_page.page import render
from reports.mesh_page.remedies import refusal
from study.meshes.as_json import as_json
from study.meshes.read import ReadOptions, read_mesh
from study.meshes.survey import Survey, survey
from study.meshes.write import check_not_same, check_output, write_mesh
from study.results.files import write_text


@dataclass(frozen=True)
class Outputs:
    """What is to be made of a survey.

    Attributes
    ----------
    print_json : bool
        Print JSON, not text.
    html, json_file, mesh : Path, optional
        Files to write: a page, JSON, and the mesh with its paths.
    """

    print_json: bool = False
    html: Path | None = None
    json_file: Path | None = None
    mesh: Path | None = None

    def check(self, file: Path) -> None:
        """Refuse outputs that could not be written before any work is done.

        Raises
        ------
        lepp.InputError
        """
        names = [path for path in (self.html, self.json_file, self.mesh) if path is not None]
        for path in names:
            check_not_same(path, file)
        if len({path.resolve() for path in names}) < len(names):
            raise lepp.InputError("Two outputs have the same name: give each its own.")
        if self.mesh is not None:
            check_output(self.mesh, file)


def survey_file(
    file: Path, options: ReadOptions, outputs: Outputs, *, equal_within: float = 0.0
) -> list[str]:
    """Survey the mesh in a file, print what its paths say, and write what is asked for.

    Parameters
    ----------
    file : Path
    options : ReadOptions
    outputs : Outputs
    equal_within : float
        As for `lepp.lepp_paths`.

    Returns
    -------
    list of str
        What was written where, a line each.

    Raises
    ------
    lepp.InputError
        A mesh that cannot be surveyed, or an output that cannot be written.
    """
    outputs.check(file)
    try:
        surveyed = survey(read_mesh(file, options), equal_within=equal_within)
    except lepp.MeshError as error:
        raise refusal(error, options) from None
    written = []
    if outputs.json_file is not None:
        write_text(outputs.json_file, _json_text(surveyed))
        written.append(f"JSON: {outputs.json_file}")
    if outputs.mesh is not None:
        write_mesh(surveyed, outputs.mesh)
        written.append(f"Mesh: {outputs.mesh}")
    if outputs.html is not None:
        write_text(outputs.html, render(surveyed))
        written.append(f"Page: {outputs.html}")
    if outputs.print_json:  # last: a reader of a pipe may go away
        sys.stdout.write(_json_text(surveyed))
    else:
        print_survey(surveyed)
    return written


def _json_text(surveyed: Survey) -> str:
    values = as_json(surveyed)
    texts = findings.warnings(surveyed)
    values["warnings"] = [entry | {"text": texts[entry["kind"]]} for entry in values["warnings"]]
    return json.dumps(values, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
