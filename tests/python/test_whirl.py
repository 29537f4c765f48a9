"""The Python module against the program's files, and against SciPy.

python3 test_whirl.py WHIRL EXAMPLES: the program, and the folder of examples. The module is found by PYTHONPATH.
"""
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
import unittest

import numpy as np
import scipy.linalg
import scipy.sparse

import whirl

WHIRL, EXAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])


def free_shaft(**step):
    """A steel shaft with an overhung disk on two damped bearings, from Python values."""
    return {
        "format": 1,
        "title": "made in Python",
        "parameters": {"k": "2e7 N/m"},
        "model": {"gravity": "9.81 m/s^2"},
        "shaft": [{"name": "rotor", "material": "steel", "columns": ["name", "length[mm]", "od[mm]"],
                   "rows": [["a", 300, 50], ["b", np.float64(400), np.int64(60)]]}],
        "disk": [{"name": "wheel", "at": "b:end", "od": "300 mm", "id": "60 mm", "width": "40 mm", "material": "steel"}],
        "bearing": [
            {"name": "DE", "at": "a:start", "type": "linear", "kxx": "1e8 N/m", "kyy": "${k}", "kzz": "1.4e7 N/m",
             "cyy": "2000 N.s/m", "czz": "2000 N.s/m"},
            {"name": "NDE", "at": "b:mid", "type": "linear", "kyy": "${k}", "kzz": "1.4e7 N/m", "kyz": "1e6 N/m",
             "kzy": "-1e6 N/m", "cyy": "2000 N.s/m", "czz": "2000 N.s/m", "cyz": "300 N.s/m", "czy": "100 N.s/m"}],
        "step": [step or {"name": "modes", "type": "modal", "speed": "12000 rpm", "modes": 10}],
    }


class InFolder(unittest.TestCase):
    def setUp(self):
        self.before = os.getcwd()
        self.folder = pathlib.Path(tempfile.mkdtemp())
        os.chdir(self.folder)

    def tearDown(self):
        os.chdir(self.before)
        shutil.rmtree(self.folder)


class Decks(InFolder):
    def test_a_dict_is_the_deck_it_describes(self):
        deck = whirl.Deck(free_shaft())
        self.assertEqual(deck.check(), [])
        resolved = tomllib.loads(deck.resolved)
        self.assertEqual(resolved["title"], "made in Python")
        self.assertEqual(resolved["bearing"][0]["kyy"], "2e7 N/m")  # the parameter, put in
        # the text runs by itself and means the same
        pathlib.Path("deck.toml").write_text(deck.text)
        self.assertEqual(whirl.load("deck.toml").resolved, deck.resolved)

    def test_text_is_kept_as_it_is(self):
        odd = 'quote " backslash \\ tab \t bell \x07 umlaut \u00fc'
        deck = whirl.Deck({**free_shaft(), "title": odd})
        self.assertEqual(tomllib.loads(deck.text)["title"], odd)
        self.assertEqual(tomllib.loads(whirl.Deck(free_shaft(), set={"title": odd}).resolved)["title"], odd)

    def test_numbers_keep_every_digit(self):
        x = 0.1 + 0.2
        for value in (x, np.float64(x)):
            deck = whirl.Deck({"format": 1, "shaft": [{"damping": {"a": value}}], "list": np.array([x, 1e300])})
            read = tomllib.loads(deck.text)
            self.assertEqual(read["shaft"][0]["damping"]["a"], x)
            self.assertEqual(read["list"], [x, 1e300])

    def test_what_a_deck_cannot_hold_is_named(self):
        with self.assertRaisesRegex(TypeError, r"disk\[0\]\.mass.*complex"):
            whirl.Deck({"disk": [{"mass": 1j}]})
        with self.assertRaisesRegex(ValueError, r"model\.gravity\[2\]"):
            whirl.Deck({"model": {"gravity": [0, 0, math.inf]}})
        with self.assertRaises(TypeError):
            whirl.Deck(17)

    def test_keys_are_set_as_the_program_sets_them(self):
        deck = whirl.load(EXAMPLES / "07_internal_damping" / "deck.toml", set={"parameters.c_external": "20 N.s/m"})
        deck["step.stability.modes"] = 3
        deck.set("step.stability.modes", 2)
        self.assertEqual(deck.settings, ['parameters.c_external="20 N.s/m"', "step.stability.modes=2"])
        asked = subprocess.run([WHIRL, "check", "--resolved", str(EXAMPLES / "07_internal_damping" / "deck.toml"),
                                "--set", "parameters.c_external=20 N.s/m", "--set", "step.stability.modes=2"],
                               capture_output=True, text=True, check=True)
        self.assertEqual(deck.resolved, asked.stdout)

    def test_errors_carry_code_place_and_hint(self):
        deck = whirl.Deck({**free_shaft(), "disk": [{"name": "w", "at": "b:end", "mass": "3 kg", "Iq": "1 kg.m^2"}]}, name="mine.toml")
        with self.assertRaises(whirl.Error) as caught:
            deck.check()
        e = caught.exception
        line = deck.text.splitlines()[e.line - 1]
        self.assertEqual((e.code, e.file, line), ("E04", "mine.toml", 'Iq = "1 kg.m^2"'))
        self.assertEqual(e.column, 1)
        self.assertIn("Ip", e.hint)
        self.assertEqual(e.exit_code, 3)
        self.assertGreaterEqual(len(e.diagnostics), 1)
        self.assertIn('Iq = "1 kg.m^2"', str(e))  # the source line, as the program prints it
        self.assertIn("mine.toml:%d:1: error[E04]" % e.line, str(e))

    def test_the_program_says_the_same(self):
        pathlib.Path("bad.toml").write_text('format = 1\n[[shaft]]\nmaterial = "stel"\ncolumns = ["length[mm]", "od[mm]"]\nrows = [[1, 2]]\n')
        said = subprocess.run([WHIRL, "check", "bad.toml"], capture_output=True, text=True)
        with self.assertRaises(whirl.Error) as caught:
            whirl.load("bad.toml").check()
        self.assertEqual(caught.exception.exit_code, said.returncode)
        self.assertTrue(said.stderr.startswith(str(caught.exception)))

    def test_a_file_that_is_not_there(self):
        with self.assertRaises(whirl.Error) as caught:
            whirl.load("nowhere.toml")
        self.assertEqual((caught.exception.code, caught.exception.exit_code), ("E02", 5))

    def test_a_deck_without_steps_does_not_run(self):
        deck = free_shaft()
        del deck["step"]
        with self.assertRaises(whirl.Error) as caught:
            whirl.Deck(deck).run("out")
        self.assertEqual(caught.exception.code, "E35")
        self.assertFalse(os.path.exists("out"))

    def test_numerical_failures_are_errors_too(self):
        loose = free_shaft()
        loose["bearing"] = loose["bearing"][:1]
        loose["bearing"][0].pop("kyy")
        with self.assertRaises(whirl.Error) as caught:
            whirl.Deck(loose).rotor().linearise(0.0)
        self.assertRegex(caught.exception.code, "E[0-9]+")
        self.assertTrue(caught.exception.message)


class Runs(InFolder):
    def test_the_files_are_those_of_the_program(self):
        source = EXAMPLES / "05_campbell_nelson_mcvaugh" / "deck.toml"
        subprocess.run([WHIRL, "run", str(source), "--quiet", "-o", "program"], check=True)
        r = whirl.load(source).run("module")
        self.assertEqual((r.exit_code, r.cancelled, str(r.folder)), (0, False, "module"))
        listed = lambda f: sorted(str(p.relative_to(f)) for p in pathlib.Path(f).rglob("*") if p.is_file())
        self.assertEqual(listed("program"), listed("module"))
        tables = [p.name for p in pathlib.Path("program").glob("*.csv")]
        self.assertGreater(len(tables), 3)
        for name in tables:
            self.assertEqual(pathlib.Path("program", name).read_bytes(), pathlib.Path("module", name).read_bytes(), name)

    def test_tables_are_arrays_with_names_and_units(self):
        r = whirl.Deck(free_shaft()).run("out")
        t = r["modes_modes"]
        with open("out/modes_modes.csv") as f:
            header = f.readline().strip().split(",")
            first = f.readline().strip().split(",")
        self.assertEqual(t.columns, header)
        self.assertEqual(len(t), 10)
        for k, title in enumerate(header):
            value = t[title][0]
            self.assertEqual(str(value) if isinstance(value, str) else float(value),
                             first[k] if isinstance(value, str) else float(first[k]), title)
        self.assertEqual(t["kind"][0], "lateral")
        self.assertIs(t["frequency [Hz]"], t["frequency [Hz]"])        # the same memory each time
        self.assertFalse(t["frequency [Hz]"].flags["OWNDATA"])          # of the table read, not a copy
        self.assertIs(r["modes_modes"], t)
        with self.assertRaisesRegex(KeyError, "several columns 'frequency'.*Hz.*rpm"):
            t["frequency"]
        with self.assertRaisesRegex(KeyError, "modes_modes"):
            r["modes"]
        self.assertEqual(r.summary, json.loads(pathlib.Path("out/summary.json").read_text()))
        self.assertEqual(whirl.results("out")["modes_modes"].columns, header)
        with self.assertRaises(whirl.Error):
            whirl.results(".")

    def test_arrays_outlive_what_they_came_from(self):
        frequency = whirl.Deck(free_shaft()).run("out")["modes_modes"]["frequency [Hz]"]
        kept = frequency.copy()
        for _ in range(100):
            np.ones(1000)  # would write over memory that is free
        np.testing.assert_array_equal(frequency, kept)

    def transient(self, duration):
        return whirl.Deck({**free_shaft(name="run", type="transient", duration=duration),
                           "drive": [{"at": "a:start", "type": "speed", "speed": "3000 rpm"}],
                           "unbalance": [{"at": "wheel", "amount": "1000 g.mm"}],
                           "probe": [{"name": "wheel", "at": "wheel"}],
                           "output": {"every": "1 ms", "report": False}})

    def test_histories(self):
        r = self.transient("0.2 s").run("out")
        self.assertIn("run", r.tables)
        self.assertEqual((r["run"]["t"][0], r["run"]["t"][-1]), (0.0, 0.2))
        self.assertEqual(r["run"].units[0], "s")
        self.assertAlmostEqual(r["run"]["speed [rpm]"][-1], 3000.0, delta=1e-5)  # about the tilted normal

    def test_progress_cancels_and_the_run_goes_on(self):
        seen = []

        def stop(step, fraction, text):
            seen.append((step, fraction, text))
            return False

        deck = self.transient("2 s")
        r = deck.run("part", stop)
        self.assertTrue(r.cancelled)
        self.assertEqual(r.exit_code, 130)
        self.assertEqual(seen[0][0], "run")
        self.assertTrue(0 <= seen[0][1] < 1)
        whole = deck.run("whole")
        self.assertFalse(whole.cancelled)  # the flag of the cancelled run is gone
        fractions = []
        rest = deck.run("part", lambda step, fraction, text: fractions.append(fraction), resume=True)
        self.assertEqual((rest.cancelled, rest.exit_code), (False, 0))
        self.assertEqual(fractions, sorted(fractions))
        for name in whole.tables:
            self.assertEqual(pathlib.Path("part", name + ".csv").read_bytes(),
                             pathlib.Path("whole", name + ".csv").read_bytes(), name)

    def test_what_the_callback_raises_comes_out(self):
        def fail(step, fraction, text):
            raise ZeroDivisionError("in the callback")

        with self.assertRaisesRegex(ZeroDivisionError, "in the callback"):
            self.transient("2 s").run("out", fail)
        self.assertTrue(os.path.exists("out/summary.json"))

    def test_other_threads_run_meanwhile(self):
        ticks, done = [], threading.Event()

        def count():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        deck = self.transient("3 s")
        counter.start()
        begin = time.monotonic()
        deck.run("out")
        end = time.monotonic()
        done.set()
        counter.join()
        during = sum(begin < t < end for t in ticks)
        self.assertGreater(during, 5, f"{during} ticks in {end - begin:.3f} s")

    def test_two_threads_may_run_decks(self):
        results, decks = {}, {k: self.transient("0.2 s") for k in ("a", "b")}

        def one(name):
            results[name] = decks[name].run(name)

        threads = [threading.Thread(target=one, args=(k,)) for k in decks]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(pathlib.Path("a/run.csv").read_bytes(), pathlib.Path("b/run.csv").read_bytes())
        self.assertFalse(results["a"].cancelled or results["b"].cancelled)

    def test_ctrl_c_is_a_keyboard_interrupt(self):
        pressed = []

        def press(step, fraction, text):
            if not pressed:
                pressed.append(fraction)
                os.kill(os.getpid(), signal.SIGINT)

        before = signal.getsignal(signal.SIGINT)
        for _ in range(2):  # the second one does not kill
            with self.assertRaises(KeyboardInterrupt):
                self.transient("5 s").run("out", press)
            self.assertLess(pressed.pop(), 1)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertTrue(os.path.exists("out/summary.json"))

    def test_nothing_is_printed(self):
        code = ("import whirl, sys; sys.stdout.flush(); "
                "whirl.load(sys.argv[1]).run('out')")
        said = subprocess.run([sys.executable, "-c", code, str(EXAMPLES / "08_asymmetric_shaft" / "deck.toml")],
                              capture_output=True, text=True)
        self.assertEqual((said.returncode, said.stdout, said.stderr), (0, "", ""))


class SmallMotions(InFolder):
    def test_eigenvalues_of_the_matrices_are_the_modes_of_the_program(self):
        """Damped, gyroscopic, cross-coupled, about the sagged rotor: SciPy's dense solver against modes.csv."""
        deck = whirl.Deck(free_shaft())
        modes = deck.run("out")["modes_modes"]
        rotor = deck.rotor()
        linear = rotor.linearise("12000 rpm")
        n = len(rotor)
        M, D, K = linear.M.toarray(), (linear.C + linear.G).toarray(), linear.K.toarray()
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        roots = scipy.linalg.eigvals(A)
        found = roots[roots.imag > 1.0]
        found = found[np.argsort(found.imag)]
        for hertz, decrement in zip(modes["frequency [Hz]"], modes["log decrement [-]"]):
            k = np.argmin(np.abs(found.imag / (2 * np.pi) - hertz) + np.abs(found.real + decrement * hertz))
            self.assertAlmostEqual(found[k].imag / (2 * np.pi) / hertz, 1.0, delta=1e-9)
            self.assertAlmostEqual(-2 * np.pi * found[k].real / found[k].imag, decrement, delta=1e-8)

    def test_modes_are_those_of_the_files_and_satisfy_the_matrices(self):
        deck = whirl.Deck(free_shaft())
        table = deck.run("out")["modes_modes"]
        rotor = deck.rotor()
        modes = rotor.modes("12000 rpm", count=10)
        np.testing.assert_allclose(modes.frequency, table["frequency [Hz]"], rtol=1e-12)
        self.assertEqual(modes.kind, table["kind"])
        self.assertTrue(modes.complete, modes.certificate)
        self.assertEqual(modes.shapes.shape, (10, len(rotor)))
        linear = rotor.linearise(12000 * np.pi / 30)
        for lam, x in zip(modes.eigenvalues, modes.shapes):
            forces = [lam ** 2 * (linear.M @ x), lam * (linear.C @ x), lam * (linear.G @ x), linear.K @ x]
            self.assertLess(np.linalg.norm(sum(forces)), 1e-9 * sum(np.linalg.norm(f) for f in forces))

    def test_matrices_are_what_they_are_called(self):
        deck = whirl.Deck(free_shaft())
        rotor = deck.rotor()
        at = rotor.linearise("12000 rpm")
        for A in (at.M, at.C, at.G, at.K):
            self.assertIsInstance(A, scipy.sparse.csr_matrix)
            self.assertEqual(A.shape, (len(rotor), len(rotor)))
            self.assertTrue(A.has_sorted_indices)
            self.assertFalse(A.data.flags["OWNDATA"])
        self.assertEqual(abs(at.C - at.C.T).max(), 0.0)
        self.assertEqual(abs(at.G + at.G.T).max(), 0.0)
        self.assertLess(abs(at.M - at.M.T).max(), 1e-9 * abs(at.M).max())
        self.assertTrue(np.all(scipy.linalg.eigvalsh(at.M.toarray()) > 0))
        self.assertAlmostEqual(at.speed, 400 * np.pi)
        # gyroscopic: with the speed, but for the skew part of the bearing's damping, (300 - 100)/2
        rest = rotor.linearise(0.0)
        names = rotor.unknowns
        y, z = (next(k for k, n in enumerate(names) if n.endswith(": " + c) and abs(rotor.stations[k] - 0.5) < 1e-9)
                for c in "yz")
        self.assertAlmostEqual(rest.G[y, z], 100.0, delta=1e-9)
        self.assertAlmostEqual(rest.C[y, z], 200.0, delta=1e-9)
        half = rotor.linearise("6000 rpm")
        np.testing.assert_allclose((at.G - rest.G).toarray(), 2 * (half.G - rest.G).toarray(), atol=1e-6 * abs(at.G).max())
        self.assertEqual(sorted(set(rotor.components)), [0, 1, 2, 3, 4, 5])

    def test_a_rigid_motion_weighs_what_the_rotor_weighs(self):
        rotor = whirl.Deck(free_shaft()).rotor(about="undeformed")
        linear = rotor.linearise(0.0)
        rho, volume = 7850.0, np.pi / 4 * (0.05 ** 2 * 0.3 + 0.06 ** 2 * 0.4 + (0.3 ** 2 - 0.06 ** 2) * 0.04)
        up = (rotor.components == 2).astype(float)
        self.assertAlmostEqual(up @ (linear.M @ up), rho * volume, delta=1e-6 * rho * volume)
        # and what holds it: both bearings
        self.assertAlmostEqual(up @ (linear.K @ up), 2.8e7, delta=1.0)

    def test_the_equilibrium_is_the_sag(self):
        deck = whirl.Deck(free_shaft())
        rotor = deck.rotor()
        linear = rotor.linearise(0.0)
        weight = -9.81 * (linear.M @ (rotor.components == 2).astype(float))
        sag = scipy.sparse.linalg.spsolve(linear.K.tocsc(), weight)
        down = rotor.components == 2
        np.testing.assert_allclose(rotor.equilibrium[down], sag[down], rtol=2e-3)
        self.assertLess(sag[down].min(), 0)

    def test_speeds_by_text(self):
        rotor = whirl.Deck(free_shaft()).rotor()
        by_number = rotor.modes(400 * np.pi, count=4).frequency
        for text in ("12000 rpm", "200 Hz", "1256.6370614359173 rad/s"):
            np.testing.assert_allclose(rotor.modes(text, count=4).frequency, by_number, rtol=1e-12)
        for wrong in ("12000 mm", "fast"):
            with self.assertRaises(ValueError):
                rotor.modes(wrong)
        with self.assertRaises(ValueError):
            rotor.modes(0.0, motion="sideways")
        with self.assertRaises(ValueError):
            whirl.Deck(free_shaft()).rotor(about="something")

    def test_setting_a_key_moves_the_modes(self):
        deck = whirl.Deck(free_shaft())
        before = deck.rotor().modes(0.0, count=2).frequency
        deck["parameters.k"] = "8e7 N/m"
        self.assertGreater(deck.rotor().modes(0.0, count=2).frequency[1], before[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
