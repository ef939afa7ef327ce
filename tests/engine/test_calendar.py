"""The calendar always knows the next event: compared with a heap, the method of textbooks."""

import heapq
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine.exact.calendar import new_calendar, next_event, schedule


def heap_of(times):
    heap = [(time, i) for i, time in enumerate(times)]
    heapq.heapify(heap)
    return heap


@settings(max_examples=40)
@given(st.integers(1, 300), st.integers(0, 2**32))
def test_the_calendar_names_the_same_next_event_as_a_heap(molecules, seed):
    random = np.random.default_rng(seed)
    calendar = new_calendar(molecules)
    times = np.full(molecules, math.inf)
    heap = []
    for _ in range(150):
        i = int(random.integers(molecules))
        # sooner, later or never again; sometimes whole numbers, so that there are ties
        time = float(random.choice([random.random(), float(random.integers(3)), math.inf], p=[0.7, 0.2, 0.1]))
        schedule(calendar, i, time)
        times[i] = time
        heapq.heappush(heap, (time, i))
        while times[heap[0][1]] != heap[0][0]:
            heapq.heappop(heap)
        who, when = next_event(calendar)
        assert when == times.min() == heap[0][0]
        assert times[who] == when


def test_taking_events_one_by_one_sorts_them():
    for molecules in [1, 7, 8, 9, 16, 17, 64, 65, 128, 129, 1000]:
        times = np.random.default_rng(molecules).random(molecules)
        calendar = new_calendar(molecules)
        for i, time in enumerate(times):
            schedule(calendar, i, time)
        taken = []
        for _ in range(molecules):
            who, when = next_event(calendar)
            taken.append((when, int(who)))
            schedule(calendar, int(who), math.inf)
        assert taken == [heapq.heappop(heap) for heap in [heap_of(times)] for _ in range(molecules)]
        assert next_event(calendar)[1] == math.inf


def test_an_empty_calendar_waits_for_ever():
    assert next_event(new_calendar(0))[1] == math.inf


def test_each_group_of_leaves_starts_on_a_cache_line():
    for molecules in (1, 8, 9, 100, 1000):
        calendar = new_calendar(molecules)
        assert (calendar.time.ctypes.data + 8 * calendar.leaf) % 64 == 0
