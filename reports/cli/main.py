"""The command line, ``lepp-study``.

Everything heavy is imported inside the commands, so that ``--help`` answers at once.
"""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from reports.cli.bench import bench
from reports.cli.mesh import mesh
from reports.cli.parameters import Bytes, Duration
from reports.cli.signals import exit_code, stop_once

if TYPE_CHECKING:
    from study.run.cluster import ClusterOptions
    from study.run.kinds import Kind
    from study.run.runner import Listener, Summary

EXIT_BAD_INPUT = 2
EXIT_FAILED_TASKS = 3


class Commands(click.Group):
    """A group of commands that answers a user's mistake with one sentence."""

    def invoke(self, ctx: click.Context) -> Any:  # noqa: ANN401 - as click declares it
        """Run a command; print the sentence of an `InputError` and exit with 2."""
        try:
            with stop_once():
                return super().invoke(ctx)
        except KeyboardInterrupt:
            click.echo("Stopped.", err=True)
            ctx.exit(exit_code())
        except OSError as error:
            if error.errno not in (errno.ENOSPC, errno.EDQUOT):
                raise
            click.echo(f"Error: Cannot write the output: {error.strerror}.", err=True)
            sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - what is left is not to be flushed
            ctx.exit(EXIT_BAD_INPUT)
        except ValueError as error:
            from lepp import InputError

            if not isinstance(error, InputError):
                raise
            click.echo(f"Error: {error}", err=True)
            ctx.exit(EXIT_BAD_INPUT)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find a command; list the known ones if there is none of that name."""
        if args and self.get_command(ctx, args[0]) is None and not args[0].startswith("-"):
            known = ", ".join(self.list_commands(ctx))
            ctx.fail(f"There is no command {args[0]!r}; the commands are {known}.")
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="lepp-study")
def main() -> None:
    """Study the longest-edge propagation path (LEPP) of random triangulations."""


main.add_command(bench)
main.add_command(mesh)


@main.command()
@click.argument("directory", required=False, type=click.Path(path_type=Path))
@click.option(
    "--preset",
    metavar="NAME",
    help="A design that comes with lepp-study: paper (if nothing else is said), delaunay, both, "
    "beyond, which goes to 10 million points and takes about an hour, beyond-billion, which goes "
    "on to a billion and takes some hours, or smoke, which takes seconds.",
)
@click.option(
    "--config",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="A design of your own, a TOML file.",
)
@click.option("--seed", metavar="N", type=int, help="Another seed than the design's.")
@click.option(
    "--workers",
    metavar="N",
    type=click.IntRange(min=1),
    help="Worker processes on this computer; one a core if not given.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Run on the Dask cluster of this scheduler, such as tcp://10.0.0.1:8786; the one that "
    "DASK_SCHEDULER_ADDRESS names if neither this nor --workers is given.",
)
@click.option(
    "--scheduler-file",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="The same, for the file that dask scheduler --scheduler-file has written.",
)
@click.option(
    "--wait",
    metavar="DURATION",
    type=Duration(),
    default="1h",
    show_default=True,
    help="How long to wait at most while that cluster has no workers, such as 90s, 30min or 2h.",
)
@click.option(
    "--worker-memory",
    metavar="BYTES",
    type=Bytes(),
    help="Memory of each worker on this computer, such as 4GB; by default they share what is free.",
)
@click.option(
    "--dashboard",
    is_flag=True,
    help="Serve Dask's dashboard of the workers on this computer, and print its address.",
)
@click.option(
    "--repair",
    is_flag=True,
    help="Compute again what is damaged or missing in DIRECTORY.",
)
@click.option(
    "--extend",
    is_flag=True,
    help="Go on from the results of a smaller design in DIRECTORY: one with fewer repetitions, "
    "sizes or distributions, and all else the same.",
)
def run(
    directory: Path | None,
    preset: str | None,
    config: Path | None,
    seed: int | None,
    workers: int | None,
    scheduler: str | None,
    scheduler_file: Path | None,
    wait: float,
    worker_memory: int | None,
    dashboard: bool,
    repair: bool,
    extend: bool,
) -> None:
    """Run a study into DIRECTORY and write its report.

    DIRECTORY is results/NAME if not given. A run that was cut short goes on where it stopped, and
    tasks that failed are tried again. The exit code is 0 if every task succeeded, 2 for bad input
    or a cluster that was lost, 3 if tasks failed, 130 after Ctrl-C and 143 after SIGTERM.
    """
    start = perf_counter()
    kind, design, directory = _choose(directory, preset, config, seed)
    from reports.cli.progress import progress
    from study.run.cluster import ClusterOptions

    options = ClusterOptions(workers, scheduler, scheduler_file, wait, dashboard, worker_memory)
    with progress() as listener:
        summary = _run(directory, kind, design, options, listener, repair=repair, extend=extend)
    computed = perf_counter()
    path = _write_report(directory)
    _print_summary(summary, computed - start, perf_counter() - computed)
    click.echo(f"Report: {path}")
    if summary.failures:
        raise SystemExit(EXIT_FAILED_TASKS)


@main.command()
@click.argument("directory", type=click.Path(path_type=Path))
def report(directory: Path) -> None:
    """Write the report of the results in DIRECTORY again."""
    click.echo(f"Report: {_write_report(directory)}")


@main.command("compile")
def compile_kernels() -> None:
    """Compile all kernels now, for an image or before many workers start."""
    import lepp
    from lepp.jit.cache import cache_directory

    lepp.compile_kernels()
    directory = cache_directory()
    if directory is None:
        from lepp import InputError

        raise InputError(
            "There is no directory to keep compiled kernels in, so every process compiles its "
            "own: set NUMBA_CACHE_DIR to one that you can write to."
        )
    click.echo(f"The kernels are kept in {directory}")


def _choose(
    directory: Path | None, preset: str | None, config: Path | None, seed: int | None
) -> tuple[Kind, Any, Path]:
    """Find the kind and the design that the options mean, and the directory for the results."""
    from lepp import InputError
    from study.design.design import Design
    from study.results.store import design_of
    from study.run.triangulations import TRIANGULATIONS

    kind: Kind = TRIANGULATIONS
    design: Any
    if preset is not None and config is not None:
        raise InputError("Give --preset or --config, not both: each is a whole design.")
    if config is not None:
        design, name = Design.from_toml(config), config.stem
    elif preset is None and directory is not None and (found := design_of(directory)) is not None:
        (kind, design), name = found, directory.name
    else:
        name = preset or "paper"
        design = Design.from_preset(name)
    if seed is not None:
        design = design.with_seed(seed)
    return kind, design, directory or Path("results") / name


def _run(
    directory: Path,
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    options: ClusterOptions,
    listener: Listener,
    **how: bool,
) -> Summary:
    from study.run.runner import run as run_design

    try:
        return run_design(directory, kind, design, options=options, listener=listener, **how)
    except KeyboardInterrupt:
        click.echo(
            f"\nStopped. What is finished is kept in {directory}; the same command goes on from "
            "there.",
            err=True,
        )
        raise SystemExit(exit_code()) from None


def _write_report(directory: Path) -> Path:
    from reports.study_page.page import write_report

    return write_report(directory)


def _print_summary(summary: Summary, run_seconds: float, report_seconds: float) -> None:
    parts, work = summary.units
    if summary.computed.parts:
        total = run_seconds + report_seconds
        click.echo(
            f"{summary.computed.parts:,} {parts}, {summary.computed.work:,} {work}, in "
            f"{total:.1f} s ({report_seconds:.1f} s of it the report)."
            + _efficiency(summary, total)
        )
    else:
        click.echo("Everything was computed already.")
    if summary.failures:
        click.echo(f"{len(summary.failures):,} tasks failed; the same command tries them again:")
        for outcome in summary.failures[:5]:
            click.echo(f"  {' '.join(map(str, outcome.task))}: {outcome.error}")
        if len(summary.failures) > 5:
            click.echo(f"  and {len(summary.failures) - 5:,} more (column error of the results)")


def _efficiency(summary: Summary, total: float) -> str:
    """Compare the seconds of a run with its tasks' own, where there were some."""
    if not (summary.kernel_seconds and summary.n_threads):
        return ""
    ideal = summary.kernel_seconds / summary.n_threads
    return (
        f" The tasks' own time is {summary.kernel_seconds:.1f} s, {ideal:.1f} s on each of "
        f"{summary.n_threads} workers: the whole took {total / ideal:.2f} times that."
    )
