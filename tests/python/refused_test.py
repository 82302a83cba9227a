# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Objects that are not whole, or not of this process, are refused by an exception: no type of the package crashes."""

import asyncio
import copy
import enum
import faulthandler
import inspect
import itertools
import os
import pickle
import signal
import tempfile
import threading
import traceback
import warnings

import numpy as np
import workspace

import dermis
from dermis import _dermis

SECONDS = 120  # of a child at most
SIM = "sim:contacts?rate=200"
ANYTHING = [None, True, -1, 0, 2**70, -(2**63), 5e-324, 1e308, float("nan"), "", "x", b"\xff", [], [1.0], [[]], (), {}]
LIMITS = '[[threat]]\nname = "hard"\nquantity = "taxel_force"\nlimit_n = 1.0\n'


def types_of_the_package():
    """All, so that a new one is here, too."""
    modules = (dermis, _dermis, dermis.circuit)
    found = {kind for module in modules for kind in vars(module).values() if isinstance(kind, type)}
    return sorted((kind for kind in found if kind.__module__.startswith("dermis")), key=lambda kind: kind.__qualname__)


def functions_of_the_package():
    modules = (dermis, _dermis, dermis.circuit)
    return [call for module in modules for call in vars(module).values() if inspect.isroutine(call)]


def has_instances(kind):
    return not issubclass(kind, (Exception, enum.Enum))


def attempt(call, *arguments):
    """The result, or the exception."""
    try:
        return call(*arguments)
    except Exception as error:
        return error


async def next_of(thing):
    return await asyncio.wait_for(thing.__anext__(), 1)


def use(thing):
    """All that can be done with an object, and what comes of it."""
    operators = [repr, str, bytes, hash, len, bool, iter, next, format, dir, copy.copy, copy.deepcopy, np.asarray]
    for operator in operators:
        attempt(operator, thing)
    for index in (0, -1, 2**70, slice(0, 2), slice(None, None, -1), "x", None):
        attempt(lambda index=index: thing[index])
    attempt(lambda: [thing == thing, thing != 1, thing < thing])
    attempt(lambda: asyncio.run(next_of(thing)))
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        attempt(lambda protocol=protocol: pickle.loads(pickle.dumps(thing, protocol)))
    for name in dir(type(thing)):
        if name in ("__init__", "__class__", "__reduce__", "__reduce_ex__", "__setstate__"):
            continue
        attribute = attempt(getattr, thing, name)
        if not callable(attribute) or isinstance(attribute, Exception):
            continue
        for arguments in ((), (thing,), (None,), (0.01,), ("x",), (thing, thing)):
            attempt(attribute, *arguments)


def hand_over(thing, beside):
    """The object as an argument of all that can be called."""
    methods = [
        attempt(getattr, one, name)
        for one in beside
        for name in dir(type(one))
        if not name.startswith("__") and name not in ("close", "stop")
    ]
    for call in [*types_of_the_package(), *functions_of_the_package(), *filter(callable, methods)]:
        if isinstance(call, Exception) or call is _dermis.serve:
            continue
        for arguments in ((thing,), (thing, thing), (thing, thing, thing), *((one, thing) for one in beside)):
            attempt(call, *arguments)


def in_child(test, work):
    """A child that fork() makes does the work: it must neither crash nor hang."""
    with tempfile.TemporaryFile("w+") as said:
        pid = os.fork()
        if pid == 0:
            status = 1
            try:
                os.dup2(said.fileno(), 2)
                faulthandler.enable(2)
                faulthandler.dump_traceback_later(SECONDS, exit=True)
                warnings.simplefilter("ignore")
                work()
                status = 0
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        said.seek(0)
        test.assertEqual(status, 0, said.read())


class Refused(workspace.CalibratedArray):
    def setUp(self):
        warnings.simplefilter("ignore")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)  # some calls write a file

    def whole(self):
        """An object of every type that has some."""
        model, recording = dermis.read_model(self.model), dermis.Recording.read(self.frames)
        pipeline, tracker = dermis.Pipeline(model), dermis.ContactTracker(model)
        forces = pipeline.run(recording)
        force = max((pipeline.process(frame) for frame in recording), key=lambda force: force.total)
        contacts = next(found for frame in recording if (found := tracker.process(pipeline.process(frame))))
        with open("limits.toml", "w") as file:
            file.write(LIMITS)
        monitor = dermis.ThreatMonitor("limits.toml", model)
        threats = next((met for frame in recording if (met := monitor.process(pipeline.process(frame)))), [])
        return [
            model,
            model.array,
            recording,
            recording[0],
            pipeline,
            tracker,
            forces,
            force,
            contacts[0],
            monitor,
            *threats[:1],
            dermis.Load(0, (0, 0), newtons=1.0),
            dermis.circuit.invert(model.array, np.zeros((5, 4))),
            dermis.Dataset([str(self.frames)]),
        ]

    def alive(self):
        """Objects with threads and devices."""
        source = dermis.open(SIM, self.array)
        self.addCleanup(source.close)
        recorded = dermis.open(self.frames)
        self.addCleanup(recorded.close)
        server = dermis.serve(SIM, self.model, port=0)
        self.addCleanup(server.stop)
        return [source, recorded, server]

    def test_what_new_alone_has_made(self):
        whole = self.whole()

        def work():
            for kind in types_of_the_package():
                print(kind, file=os.fdopen(2, "w", closefd=False), flush=True)
                thing = attempt(kind.__new__, kind)
                if isinstance(thing, Exception):
                    continue
                for name, member in inspect.getmembers(kind, inspect.isdatadescriptor):
                    if isinstance(member, property):
                        refusal = attempt(getattr, thing, name)
                        assert isinstance(refusal, (TypeError, AttributeError)), (kind, name, refusal)
                use(thing)
                hand_over(thing, whole)

        in_child(self, work)

    def test_what_a_class_of_a_user_has_not_made(self):
        def work():
            for kind in filter(has_instances, types_of_the_package()):
                careless = attempt(type, "Careless", (kind,), {"__init__": lambda self: None})
                thing = attempt(careless)
                use(thing)
                use(attempt(kind.__new__, careless))

        in_child(self, work)

    def test_what_a_foreign_pickle_has_made(self):
        whole = self.whole()

        def work():
            pickled = 0
            for thing in whole:
                reduced = attempt(thing.__reduce_ex__, 2)
                if isinstance(reduced, Exception) or not hasattr(thing, "__setstate__"):
                    continue
                pickled += 1
                state = reduced[2] if isinstance(reduced[2], tuple) else (reduced[2],)
                wrong = [state[:-1], (*state, 1), state[::-1], ()]
                places = itertools.product(range(len(state)), [*ANYTHING, 10**6, 2**40, [0.0] * 7])
                wrong += [(*state[:k], part, *state[k + 1 :]) for k, part in places]
                for some in wrong:
                    other = type(thing).__new__(type(thing))
                    refusal = attempt(other.__setstate__, some)
                    assert refusal is None or "damaged" in str(refusal) or isinstance(refusal, TypeError), refusal
                    for name in dir(type(thing)):
                        attempt(getattr, other, name)
                    for operator in (repr, len, copy.deepcopy, lambda other=other: other[0]):
                        attempt(operator, other)
            assert pickled >= 5, pickled

        in_child(self, work)

    def test_every_type_that_has_objects_is_whole_and_used_here(self):
        seen = {type(thing) for thing in [*self.whole(), *self.alive()]}
        elsewhere = {dermis.CalibrationReport, dermis.Recogniser, dermis.Recognition, dermis.Suit, dermis.SuitArray}
        self.assertEqual(set(filter(has_instances, types_of_the_package())) - seen - elsewhere, set())

    def test_what_is_whole_may_be_used_in_every_way(self):
        whole = self.whole()
        in_child(self, lambda: [use(thing) for thing in whole])

    def test_what_is_closed(self):
        for thing in self.alive():
            attempt(getattr(thing, "close", None) or thing.stop)
            use(thing)

    def test_what_is_of_the_process_before_a_fork(self):
        source, recorded, server = self.alive()
        next(source)
        whole = self.whole()

        def work():
            for thing in (source, recorded):
                for call in (thing.latest, thing.__next__):
                    refusal = attempt(call)
                    assert isinstance(refusal, dermis.Failed) and "fork" in str(refusal), refusal
            for thing in [source, recorded, server, *whole]:
                use(thing)
            assert server.stop() is None and source.close() is None

        in_child(self, work)
        next(source)

    def test_a_child_calibrates_as_its_parent_has(self):
        arguments = (self.array, self.folder / "calibration/frames.csv", self.folder / "calibration/loads.csv")
        dermis.calibrate(*arguments)
        in_child(self, lambda: dermis.calibrate(*arguments))

    def test_threads_read_and_close_one_source_of_a_file(self):
        for _ in range(50):
            source = dermis.open(self.frames)
            threads = [threading.Thread(target=attempt, args=(list, source)) for _ in range(3)]
            threads += [threading.Thread(target=source.close) for _ in range(2)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join(SECONDS)
                self.assertFalse(thread.is_alive())

    def test_threads_ask_for_one_dataset(self):
        recording = dermis.Recording.read(self.frames)
        recording.write("recording.mcap")
        dataset = dermis.Dataset(["recording.mcap"], model=self.model)
        lengths = []
        threads = [threading.Thread(target=lambda: lengths.append(len(dataset))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(SECONDS)
        self.assertEqual(lengths, [1] * 4)

    def test_numbers_at_the_ends_of_their_range(self):
        counts = np.zeros((3, 1, 1))
        with self.assertRaisesRegex(ValueError, "rate_hz: .* 292 years"):
            dermis.Recording(counts, rate_hz=1e-308)
        with self.assertRaisesRegex(ValueError, "at most 1048576 taxels"):
            dermis.Recording(np.zeros((0, 2**40, 1)), rate_hz=1.0)
        self.assertEqual(dermis.Recording(counts, rate_hz=1e-9).time_ns[-1], 2 * 10**18)
        times = np.array([-(2**63), 0, 2**63 - 1])
        recording = dermis.Recording(counts, time_ns=times)
        in_child(
            self, lambda: (use(recording), [attempt(recording.write, f"x.{kind}") for kind in ("csv", "mcap", "npy")])
        )


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)
    workspace.main()
