"""Claims about which camera frames have what in a recording."""

from treadwell.recording.rhythm import Rhythm

FRAME_NS = 80_000_000


def test_maps_are_due_every_third_of_a_second_and_guesses_at_every_other_frame() -> None:
    rhythm, maps, guesses = Rhythm(), [], []
    for i in range(9):
        rhythm.frame(i * FRAME_NS)
        maps.append(rhythm.map)
        guesses.append(rhythm.guesses)
    assert maps == [True, False, False, False, True, False, False, False, True]
    assert guesses == [True, False, True, False, True, False, True, False, True]


def test_voxels_stay_due_until_there_are_any_and_then_every_twelfth_frame() -> None:
    rhythm, due = Rhythm(), []
    for i in range(30):
        rhythm.frame(i * FRAME_NS)
        if rhythm.voxels:
            due.append(i)
            if i >= 3:
                rhythm.voxels_taken()
    assert due == [0, 1, 2, 3, 15, 27]
