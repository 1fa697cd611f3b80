"""What the captions of the data's figures say, counted anew."""

from made_runs import page, run


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
