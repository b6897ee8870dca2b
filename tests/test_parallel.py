import threading
import time

import pytest

from core.parallel import in_order


def test_results_come_in_order_though_later_ones_finish_first():
    def wait(number):
        time.sleep(0.02 if number % 2 == 0 else 0.0)
        return number

    assert list(in_order(wait, range(9), workers=3)) == list(range(9))


def test_only_a_few_items_are_taken_ahead():
    taken = []

    def items():
        for number in range(100):
            taken.append(number)
            yield number

    results = in_order(lambda number: number, items(), workers=2)
    assert next(results) == 0
    assert len(taken) <= 3
    results.close()


def test_errors_reach_the_caller_and_no_thread_is_left():
    def fail(number):
        raise ValueError(str(number))

    with pytest.raises(ValueError, match="0"):
        list(in_order(fail, range(5)))
    assert threading.active_count() == 1
