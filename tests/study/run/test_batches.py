from itertools import pairwise

from study.design.design import Design
from study.run.batches import BATCH_WORK, Batch, Batches, Load
from study.run.triangulations import TRIANGULATIONS


def drained(batches):
    """All batches as they would be sent if each ended at once."""
    taken = []
    while (batch := batches.next()) is not None:
        batches.begin(len(taken), batch)
        taken.append(batches.end(len(taken)))
    return taken


def test_batches_hold_every_task_once_the_largest_first():
    tasks = TRIANGULATIONS.tasks_of(Design.from_preset("paper"))
    batches = drained(Batches([(task, Load(task.n_points, 1)) for task in tasks], 2))
    flat = [task for batch in batches for task in batch.tasks]
    assert sorted(flat) == sorted(tasks)
    assert [t.n_points for t in flat] == sorted((t.n_points for t in tasks), reverse=True)
    points = [sum(task.n_points for task in batch.tasks) for batch in batches]
    assert max(points) <= BATCH_WORK
    assert len(batches) < 250
    assert max(points[-4:]) < BATCH_WORK / 4


def test_a_task_larger_than_a_batch_is_one():
    tasks = [(k, Load(3 * BATCH_WORK, 1)) for k in range(3)]
    assert [batch.tasks for batch in drained(Batches(tasks, 1))] == [[0], [1], [2]]


def test_a_batch_takes_the_memory_of_its_largest_task():
    tasks = [(k, Load(1, memory)) for k, memory in enumerate((3, 9, 5))] + [(3, Load(100, 1))]
    batches = drained(Batches(tasks, 1))
    assert {task for batch in batches for task in batch.tasks} == {0, 1, 2, 3}
    for batch in batches:
        assert batch.memory == max(dict(tasks)[task].memory for task in batch.tasks)


def test_what_does_not_fit_side_by_side_runs_one_after_the_other():
    large, small = BATCH_WORK, BATCH_WORK // 2 + 1
    tasks = [("a", Load(large, 70)), ("b", Load(large, 70)), *((k, Load(small, 20)) for k in "cd")]
    batches = Batches(tasks, 1, memory=100)
    first = batches.next()
    assert first == Batch(["a"], 70)
    batches.begin("a", first)
    second = batches.next()
    assert second == Batch(["c"], 20)  # beside a there is no room for b
    batches.begin("c", second)
    assert batches.next() is None
    assert len(batches) == 2
    assert batches.end("c") == second
    assert batches.end("a") == first
    third = batches.next()
    assert third == Batch(["b"], 70)
    batches.begin("b", third)
    assert batches.next() == Batch(["d"], 20)


def test_exactly_as_much_as_there_is_fits():
    tasks = [(k, Load(BATCH_WORK, 50)) for k in range(3)]
    batches = Batches(tasks, 1, memory=100)
    for k in range(2):
        batches.begin(k, batches.next())
    assert batches.next() is None
    fewer = Batches(tasks, 1, memory=99)
    fewer.begin(0, fewer.next())
    assert fewer.next() is None


def test_a_task_larger_than_memory_runs_when_no_other_does():
    batches = Batches([("huge", Load(9, 500)), ("small", Load(BATCH_WORK, 1))], 1, memory=100)
    order = [batch.tasks for batch in drained(batches)]
    assert sorted(order) == [["huge"], ["small"]]


def test_a_task_waits_again_by_itself_before_the_others_of_its_size():
    batches = Batches([(k, Load(BATCH_WORK, 5)) for k in range(3)], 1)
    first = batches.next()
    batches.begin(0, first)
    batches.end(0)
    batches.again(0, 5)
    assert [batch.tasks for batch in drained(batches)] == [[0], [1], [2]]


def test_large_ones_come_before_small_ones():
    tasks = [(k, Load(BATCH_WORK + k, BATCH_WORK + k)) for k in range(5)]
    taken = drained(Batches(tasks, 3, memory=BATCH_WORK + 9))
    assert all(a.memory > b.memory for a, b in pairwise(taken))
