"""A worker that tells what it is told, and with "sleep" sleeps for ever."""

import time

from vbraille.workers import begin

if __name__ == "__main__":
    orders, told = begin(str)
    print("printed", flush=True)
    while not orders.ended:
        orders.wait(None if told.flush() else 0.01)
        for order in orders.take():
            if order == "sleep":
                time.sleep(600)
            told.put(order)
