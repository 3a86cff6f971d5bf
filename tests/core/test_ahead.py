import threading

import pytest
from silhouette_mocap.core.ahead import Behind, made_ahead


def test_items_come_in_order_each_made_while_the_one_before_is_used():
    made, used = [], threading.Event()

    def items():
        for number in range(3):
            if number == 2:
                assert used.wait(5)
            made.append(number)
            yield number

    found = made_ahead(items())
    assert next(found) == 0
    assert next(found) == 1
    used.set()
    assert list(found) == [2]
    assert made == [0, 1, 2]


def test_what_making_an_item_raises_comes_in_its_place():
    def items():
        yield 1
        raise KeyError("gone")

    found = made_ahead(items())
    assert next(found) == 1
    with pytest.raises(KeyError, match="gone"):
        next(found)


def test_calls_behind_come_one_after_another_and_are_finished_at_the_end():
    done, go = [], threading.Event()
    with Behind() as behind:
        behind.call(lambda: (go.wait(5), done.append(1)))
        assert done == []
        go.set()
        behind.call(done.append, 2)
    assert done == [1, 2]


def test_a_call_behind_that_fails_is_told_by_the_next_one():
    def fail():
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"), Behind() as behind:
        behind.call(fail)
        behind.call(print)
    with pytest.raises(OSError, match="disk full"), Behind() as behind:
        behind.call(fail)


def test_an_interrupt_waits_for_the_call_behind():
    done, go = [], threading.Event()
    with pytest.raises(KeyboardInterrupt), Behind() as behind:
        behind.call(lambda: (go.wait(5), done.append(1)))
        threading.Timer(0.05, go.set).start()
        raise KeyboardInterrupt
    assert done == [1]
