"""What the captions of the data's figures say, counted anew."""

from made_runs import DESIGN, page, run
from page_text import drawn, page_text

from reports.page.views import distribution_word


def mean_of(distribution: str, results, n: int = 8000) -> float:
    rows = results[(results["distribution"] == distribution) & (results["n_points"] == n)]
    return rows.loc[rows["method"] == "incremental", "mean_lepp"].mean()


def test_distributions_stand_side_by_side() -> None:
    design = DESIGN.model_copy(update={"distributions": ("uniform", "normal", "exponential")})
    results = drawn(design)
    said = page_text(results).finding("figure-distributions")
    means = {name: mean_of(name, results["results"]) for name in design.distributions}
    listed = [f"{mean:.4f} ({distribution_word(name)})" for name, mean in means.items()]
    assert f"are {', '.join(listed[:-1])} and {listed[-1]}: they lie" in said
    gap = max(means.values()) - min(means.values())
    assert said.endswith(f"within {gap:.4f} of one another.")


def test_a_distribution_alone_is_held_against_none() -> None:
    design = DESIGN.model_copy(update={"distributions": ("uniform",)})
    results = drawn(design)
    mean = mean_of("uniform", results["results"])
    said = page_text(results).finding("figure-distributions")
    assert said == f"At 8,000 points the mean LEPP size is {mean:.4f} (uniform)."


def test_captions_of_the_two_figures_of_all_triangulations_differ() -> None:
    results = run("drawn")["results"]
    rows = results[(results["method"] == "incremental") & (results["distribution"] == "uniform")]
    lowest = rows.loc[rows["mean_lepp"].idxmin()]
    highest = rows.loc[rows["mean_lepp"].idxmax()]
    assert page("drawn").finding("figure-triangulations") == (
        f"The means of {len(rows)} triangulations lie between {lowest['mean_lepp']:.4f}, at "
        f"{lowest['n_points']:,} points, and {highest['mean_lepp']:.4f}, at "
        f"{highest['n_points']:,}."
    )
    assert page("drawn").finding("figure-groups").startswith("The spread between triangulations")
