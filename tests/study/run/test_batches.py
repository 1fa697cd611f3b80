from itertools import pairwise

from study.design.design import Design
from study.run.batches import BATCH_SECONDS, Batch, Batches, Load
from study.run.triangulations import TRIANGULATIONS


def batches_of(loads, memory=None):
    """Batches of tasks by name, with their loads."""
    loads = dict(loads)
    return Batches(loads, loads.__getitem__, memory)


def drained(batches, seconds_of=None, n_threads=1):
    """All batches as they would be sent if each ended at once."""
    taken = []
    while (batch := batches.next(n_threads)) is not None:
        batches.begin(len(taken), batch)
        taken.append(batches.end(len(taken)))
        if seconds_of:
            batches.learn(len(batch.tasks), sum(map(seconds_of, batch.tasks)), n_threads)
    assert batches.n_waiting == 0 == batches.smallest()
    return taken


def test_batches_hold_every_task_once_the_largest_first_and_take_about_a_second():
    tasks = TRIANGULATIONS.tasks_of(Design.from_preset("paper"))
    batches = Batches(tasks, lambda task: Load(task.n_points, 1))

    def seconds(task):
        return task.n_points * 1e-6

    taken = drained(batches, seconds, 2)
    flat = [task for batch in taken for task in batch.tasks]
    assert sorted(flat) == sorted(tasks)
    assert [t.n_points for t in flat] == sorted((t.n_points for t in tasks), reverse=True)
    times = [sum(map(seconds, batch.tasks)) for batch in taken]
    assert len(taken[0].tasks) == 1
    assert max(times) < 1.1 * BATCH_SECONDS
    assert 0.5 < sum(times[5:-20]) / len(times[5:-20]) <= BATCH_SECONDS
    assert max(times[-4:]) < BATCH_SECONDS / 4


def test_tiny_tasks_are_sent_many_together_as_soon_as_their_time_is_known():
    taken = drained(batches_of((k, Load(100, 1)) for k in range(100_000)), lambda _: 0.002)
    sizes = [len(batch.tasks) for batch in taken]
    assert sizes[:5] == [1, 8, 64, 500, 500]
    assert max(sizes) == 500
    assert sizes[-1] == 1


def test_a_first_task_that_took_long_is_forgotten():
    batches = batches_of((k, Load(100, 1)) for k in range(1000))
    batches.learn(1, 2.5, 1)  # it loaded the kernels
    assert len(batches.next(1).tasks) == 1
    batches.learn(1, 0.02, 1)
    assert len(batches.next(1).tasks) == 8


def test_with_very_many_threads_batches_are_longer():
    batches = batches_of((k, Load(100, 1)) for k in range(100_000))
    batches.learn(10, 0.1, 200)
    assert len(batches.next(200).tasks) == 80
    batches.learn(80, 1.6, 200)
    assert len(batches.next(200).tasks) == 100


def test_a_task_that_takes_long_is_a_batch():
    tasks = [(k, Load(3, 1)) for k in range(3)]
    assert [batch.tasks for batch in drained(batches_of(tasks), lambda _: 3.0)] == [[0], [1], [2]]


def test_a_batch_takes_the_memory_of_its_largest_task():
    tasks = {k: Load(100 - k, memory) for k, memory in enumerate((3, 9, 5, 1))}
    batches = batches_of(tasks)
    batches.learn(100, 0.1, 0)
    taken = drained(batches)
    assert {task for batch in taken for task in batch.tasks} == {0, 1, 2, 3}
    for batch in taken:
        assert batch.memory == max(tasks[task].memory for task in batch.tasks)


def test_what_does_not_fit_side_by_side_runs_one_after_the_other():
    tasks = [("a", Load(9, 70)), ("b", Load(9, 70)), *((k, Load(5, 20)) for k in "cd")]
    batches = batches_of(tasks, memory=100)
    first = batches.next(1)
    assert first == Batch(["a"], 70)
    batches.begin("a", first)
    second = batches.next(1)
    assert second == Batch(["c"], 20)  # beside a there is no room for b
    batches.begin("c", second)
    assert batches.next(1) is None
    assert len(batches.under_way) == 2
    assert batches.end("c") == second
    assert batches.end("a") == first
    third = batches.next(1)
    assert third == Batch(["b"], 70)
    batches.begin("b", third)
    assert batches.next(1) == Batch(["d"], 20)


def test_exactly_as_much_as_there_is_fits():
    tasks = [(k, Load(1, 50)) for k in range(3)]
    batches = batches_of(tasks, memory=100)
    for k in range(2):
        batches.begin(k, batches.next(1))
    assert batches.next(1) is None
    fewer = batches_of(tasks, memory=99)
    fewer.begin(0, fewer.next(1))
    assert fewer.next(1) is None


def test_a_task_larger_than_memory_runs_when_no_other_does():
    batches = batches_of([("huge", Load(9, 500)), ("small", Load(1, 1))], memory=100)
    order = [batch.tasks for batch in drained(batches)]
    assert sorted(order) == [["huge"], ["small"]]


def test_what_no_worker_has_memory_for_waits_for_one():
    batches = batches_of([("huge", Load(9, 500)), ("small", Load(1, 50))])
    assert batches.next(1, largest=49) is None
    assert batches.smallest() == 50
    assert batches.next(1, largest=50) == Batch(["small"], 50)
    assert batches.next(1, largest=499) is None
    assert (batches.smallest(), batches.n_waiting) == (500, 1)
    assert batches.next(1, largest=500) == Batch(["huge"], 500)


def test_a_task_waits_again_by_itself_before_the_others():
    batches = batches_of((k, Load(5, 5)) for k in range(3))
    batches.begin(0, batches.next(1))
    batches.end(0)
    batches.again(0)
    assert batches.next(1, largest=4) is None
    assert [batch.tasks for batch in drained(batches)] == [[0], [1], [2]]


def test_large_ones_come_before_small_ones():
    tasks = [(k, Load(100 + k, 100 + k)) for k in range(5)]
    taken = drained(batches_of(tasks, memory=109))
    assert all(a.memory > b.memory for a, b in pairwise(taken))
