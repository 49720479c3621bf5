"""Make `oracle.json`: what questplus 2023.1 asks in simulated sessions.

questplus is under the GPL, so that it is no part of the program nor of its tests' requirements.
In an environment of its own: ``pip install questplus==2023.1``, then ``python oracle.py``. The
machinery of QUEST+ (posterior, expected entropy, choice, estimate) is all questplus's. So are the
psychometric functions, but for that of pairs, which it has none of; it is written here anew.
"""

import json
from importlib.metadata import version
from pathlib import Path

import numpy as np
import xarray
from questplus import QuestPlus
from scipy.stats import norm

TRIALS = 72
SEEDS = (1, 2, 3)


def span(low, high, count):
    return [round(value, 6) for value in np.linspace(low, high, count).tolist()]


def model(name, family, stimuli, axes, truth):
    return {
        "name": name, "family": family, "stimuli": stimuli, "axes": axes, "truth": truth,
    }  # fmt: skip


THRESHOLDS, SPREADS = span(0.5, 4.5, 41), [0.5, 1.0, 2.0]
MODELS = [
    model(
        "weibull, yes or no", "weibull", [span(0.25, 5, 39)],
        {"threshold": THRESHOLDS, "spread": SPREADS, "guess": [0.02], "lapse": [0.02]},
        (2.3, 1.4, 0.02, 0.02),
    ),
    model(
        "weibull, one of two, with lapses", "weibull", [span(0.25, 5, 20)],
        {"threshold": THRESHOLDS[::2], "spread": [1.0, 2.0, 4.0], "guess": [0.5],
         "lapse": [0.0, 0.03, 0.06]},
        (1.4, 2.0, 0.5, 0.05),
    ),
    model(
        "normal, one of two, guesses unknown", "normal", [span(0, 10.3, 42)],
        {"threshold": span(1, 9, 25), "spread": [0.5, 1.0, 2.0], "guess": [0.4, 0.5, 0.6],
         "lapse": [0.02]},
        (4.1, 1.0, 0.5, 0.02),
    ),
    model(
        "nearer of two", "nearer", [span(0.5, 2.9, 17), span(0.57, 2.97, 17)],
        {"centre": span(0.5, 3.0, 26), "spread": [0.1, 0.2, 0.4, 0.8], "lapse": [0.03]},
        (1.83, 0.25, 0.03),
    ),
    model(
        "nearer of two, by ratio, with lapses", "nearer log",
        [span(0.5, 2.9, 13), span(0.57, 2.97, 13)],
        {"centre": span(0.6, 3.0, 25), "spread": [0.05, 0.1, 0.2, 0.4], "lapse": [0.01, 0.05]},
        (1.13, 0.12, 0.03),
    ),
]  # fmt: skip
_NAMES = {
    "normal": ("norm_cdf", ("mean", "sd", "lower_asymptote", "lapse_rate")),
    "weibull": ("weibull", ("threshold", "slope", "lower_asymptote", "lapse_rate")),
    "nearer": ("norm_cdf", ("centre", "spread", "lapse")),
}


class Nearer(QuestPlus):
    """questplus with the likelihoods of pairs."""

    log = False

    def _gen_likelihoods(self):
        domain = {**self.stim_domain, **self.param_domain}
        of = {n: xarray.DataArray(v, dims=[n], coords={n: v}) for n, v in domain.items()}
        chosen = _nearer(*(of[n] for n in ("first", "second", "centre", "spread", "lapse")),
                         log=self.log)  # fmt: skip
        parts = [p.expand_dims({"response": [r]}) for p, r in ((chosen, "Yes"), (1 - chosen, "No"))]
        return xarray.concat(parts, dim="response", coords=self.outcome_domain)


class NearerByRatio(Nearer):
    """The same where distances are judged by their ratio."""

    log = True


def _nearer(first, second, centre, spread, lapse, *, log):
    if log:
        first, second, centre = np.log(first), np.log(second), np.log(centre)
    further = abs(second - centre) - abs(first - centre)
    chosen = xarray.apply_ufunc(norm.cdf, further / (spread * np.sqrt(2)))
    return lapse / 2 + (1 - lapse) * chosen


def chance(family, stimulus, truth):
    """Probability of the positive outcome for the one who is simulated."""
    if family.startswith("nearer"):
        return float(_nearer(*map(np.float64, (*stimulus, *truth)), log=family.endswith("log")))
    at, spread, guess, lapse = truth
    (x,) = stimulus
    shape = norm.cdf((x - at) / spread) if family == "normal" else 1 - np.exp(-((x / at) ** spread))
    return float(guess + (1 - guess - lapse) * shape)


def trace(told, seed):
    func, names = _NAMES[told["family"].split()[0]]
    kind = {"nearer": Nearer, "nearer log": NearerByRatio}.get(told["family"], QuestPlus)
    of = dict(zip(told["axes"], names, strict=True))
    domain = ("first", "second") if func != "weibull" and kind is not QuestPlus else ("intensity",)
    quest = kind(
        stim_domain=dict(zip(domain, told["stimuli"], strict=True)),
        param_domain={of[name]: values for name, values in told["axes"].items()},
        outcome_domain={"response": ["Yes", "No"]},
        func=func,
        stim_scale="linear",
        stim_selection_method="min_entropy",
        param_estimation_method="mean",
    )
    random = np.random.default_rng(seed)
    asked = []
    for _ in range(TRIALS):
        chosen = quest.next_stim
        stimulus = [chosen[name] for name in domain]
        yes = random.random() < chance(told["family"], stimulus, told["truth"])
        quest.update(stim=chosen, outcome={"response": "Yes" if yes else "No"})
        asked.append([*stimulus, int(yes)])
    found = {name: float(quest.param_estimate[of[name]]) for name in told["axes"]}
    return {"seed": seed, "asked": asked, "found": found}


def main():
    models = []
    for told in MODELS:
        models.append(told | {"traces": [trace(told, seed) for seed in SEEDS]})
        print(told["name"])
    made = {"by": f"questplus {version('questplus')}", "models": models}
    Path(__file__).with_name("oracle.json").write_text(json.dumps(made) + "\n")


if __name__ == "__main__":
    main()
