"""The calendar always knows the next event: compared with a heap, the method of textbooks."""

import heapq
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine.exact.calendar import new_calendar, next_event, schedule


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


def test_an_empty_calendar_waits_for_ever():
    assert next_event(new_calendar(0))[1] == math.inf
