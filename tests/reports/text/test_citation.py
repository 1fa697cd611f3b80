from dataclasses import replace
from pathlib import Path

import yaml
from frames import design

from reports.text.citation import (
    SOFTWARE_AUTHOR,
    SOFTWARE_LICENSE,
    SOFTWARE_TITLE,
    paper_entry,
    paper_in_words,
    report_entry,
    versions,
)
from study.paper.published import CITATION

ROOT = Path(__file__).parents[3]


def manifest(*recorded: str) -> dict:
    return {"environments": [{"packages": {"lepp-study": version}} for version in recorded]}


def test_the_software_is_cited_as_its_citation_file_says() -> None:
    file = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert file["title"] == SOFTWARE_TITLE
    assert [author["name"] for author in file["authors"]] == [SOFTWARE_AUTHOR]
    assert file["license"] == SOFTWARE_LICENSE
    assert "date-released" not in file  # with one, the entry of the report needs its year
    assert file["version"] in versions({})


def test_the_entry_of_a_report_names_what_it_takes_to_make_it_again() -> None:
    entry = report_entry(
        "How far?", design(seed=7, methods=("a_b",)), manifest("1.2", "1.2", "1.3")
    )
    assert entry.startswith("@misc{lepp-study-seed-7,\n")
    assert "  version = {1.2, 1.3},\n" in entry
    assert "seed 7; methods a\\_b; distributions uniform, exponential" in entry
    assert "4 numbers of points, 1000 to 8000; 6 repetitions" in entry
    assert "year" not in entry
    single = report_entry("How far?", design(sizes=(300,)), manifest("1.2"))
    assert "1 number of points, 300; 6" in single
    each = design(sizes=(300, 600, 900), repetitions=(9, 4, 1))
    assert "300 to 900; 9, 4 and 1 repetitions}" in report_entry("How far?", each, manifest("1.2"))


def test_the_entry_of_the_paper_has_its_doi_only_where_that_is_confirmed() -> None:
    entry = paper_entry(replace(CITATION, doi="10.1/a_b", doi_confirmed=True))
    assert entry.startswith("@inproceedings{vilcahuayta2020,\n")
    assert "author = {Vilca Huayta, Oliver-Amadeo and Rivara, María-Cecilia}" in entry
    assert "year = {2020}" in entry
    assert "doi = {10.1/a_b}" in entry
    assert "doi" not in paper_entry(replace(CITATION, doi_confirmed=False))


def test_the_paper_in_words() -> None:
    assert paper_in_words(CITATION) == (
        "Oliver-Amadeo Vilca Huayta and María-Cecilia Rivara, “Study on the Average Size of the "
        "Longest-Edge Propagation Path for Triangulations” (GRAPP 2020)"
    )
