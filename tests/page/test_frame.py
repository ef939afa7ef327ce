"""Frames as bytes."""

import struct

import numpy as np

from atmosbox.page.frame import clumps, encode
from atmosbox.page.stage import MOST, chosen, share


def read(frame):
    """Return the content of the bytes of a frame, decoded as its docstring describes."""
    sequence, time, x, y, z, number, highest = struct.unpack_from("<Id3fIf", frame)
    place = np.frombuffer(frame, "<u2", 3 * number, 32).reshape(-1, 3)
    speed = np.frombuffer(frame, np.uint8, number, 32 + 6 * number)
    state = np.frombuffer(frame, np.uint8, number, 32 + 7 * number)
    (drops,) = struct.unpack_from("<I", frame, 32 + 8 * number)
    wet = np.frombuffer(frame, "<f4", 4 * drops, 36 + 8 * number).reshape(-1, 4)
    assert len(frame) == 36 + 8 * number + 16 * drops
    return sequence, time, (x, y, z), place, speed / 255.0 * highest, state, wet


def test_a_frame_says_where_everything_is_and_how_fast():
    rng = np.random.default_rng(1)
    length = np.array([2.0, 3.0, 5.0])
    position, speed = rng.random((50, 3)) * length, rng.random(50) * 900.0
    drops = np.array([[1.0, 2.0, 3.0, 0.5]])
    sequence, time, sides, place, fast, state, wet = read(encode(4, 1.25, length, position, speed, 900.0, drops))
    assert (sequence, time, sides) == (4, 1.25, (2.0, 3.0, 5.0))
    np.testing.assert_allclose(place / 65535.0 * length, position, atol=5.0 / 65535.0)
    np.testing.assert_allclose(fast, speed, atol=900.0 / 255.0)
    assert not state.any()
    np.testing.assert_array_equal(wet, drops)


def test_a_large_run_is_thinned_to_its_share_of_the_page():
    for molecules in [1, 300, 4999, 30_000, 1_000_000]:
        for frames in [1, 240, 1000, 1_000_000]:
            for runs in [1, 2]:
                kept = share(molecules, frames, runs)
                assert 1 <= kept.molecules <= min(molecules, MOST)
                assert 1 <= kept.frames <= frames
                assert kept.molecules * kept.frames * runs <= 850_000


def test_water_is_drawn_before_air():
    water = np.arange(1000) % 50 == 0
    found = chosen(1000, 100, water)
    assert len(found) == 100
    assert np.isin(np.flatnonzero(water), found).all()
    assert (np.diff(found) > 0).all()


def test_clumps_stay_where_they_are_while_they_grow_and_lie_in_the_box():
    length = np.array([2.0, 1.0, 4.0])
    few, many = clumps(40, 600, length, 0.01), clumps(600, 600, length, 0.01)
    np.testing.assert_array_equal(few[:, :3], many[:, :3])
    np.testing.assert_allclose((many[:, 3] / few[:, 3]) ** 3, 15.0)
    assert ((many[:, :3] > 0.0) & (many[:, :3] < length)).all()
    assert len(clumps(3, 600, length, 0.01)) == 3
