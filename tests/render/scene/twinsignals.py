"""Signals in plain Python, straight from Lévesque 2009, eqs. 9.6-9.10: the twin of the kernels."""

import math

from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch

# Signals that pictures of tests have, with all switches as at first.
SIGNALS = {
    "none": Switch(levels=(0.0, 1.0)),
    "half": Switch(levels=(0.4, 1.0)),
    "all": Inverse(of="none"),
}


def falling(value, first, last):
    """α of eqs. 9.6 and 9.8, with the sign by which it falls."""
    if value < first:
        return 1.0
    return (last - value) / (last - first) if value < last else 0.0


class Signals:
    """Values of signals, step by step; they begin as if all had been for long as it is."""

    def __init__(self, signals, driving=()):
        self.signals, self.driving = signals, driving
        self.values = {}
        self._since = dict.fromkeys(signals, math.inf)  # t - t0 of eq. 9.7
        self._high = dict.fromkeys(signals, True)
        self._passed = dict.fromkeys(driving, 0.0)

    def step(self, passed_s, velocity=(0.0, 0.0), time_s=0.0, states=None):
        """Values after so long, by their names; those of integrals by ∫ and the name."""
        self._given = passed_s, velocity, time_s, states or {}
        before, self.values = self.values, {}
        for name in self.signals:
            self._find(name, before)
        for name in self.driving:
            self._passed[name] += passed_s * self.values[name]
            self.values[f"∫{name}"] = self._passed[name]
        return self.values

    def _find(self, name, before):
        if name not in self.values:
            self.values[name] = self._value(name, self.signals[name], before)
        return self.values[name]

    def _value(self, name, signal, before):
        passed_s, velocity, time_s, states = self._given
        speed = math.hypot(*velocity)
        match signal:
            case Speed():
                last = signal.below_mm_s + signal.transition_mm_s
                self._since[name] = self._since[name] + passed_s if speed < last else 0.0
                value, tau = falling(speed, signal.below_mm_s, last), signal.delay_s
                since = self._since[name]
                if since < tau:
                    return 0.0
                return value * (since - tau) / tau if since < 2 * tau else value
            case Direction():
                way = math.degrees(math.atan2(velocity[1], velocity[0]))
                away = abs((way - signal.angle_deg + 180) % 360 - 180)
                if signal.axis:
                    away = min(away, 180 - away)
                alpha = falling(
                    away, signal.tolerance_deg, signal.tolerance_deg + signal.transition_deg
                )
                last = signal.below_mm_s + signal.slow_transition_mm_s
                slow = falling(speed, signal.below_mm_s, last)
                high, low = max(alpha, slow), min(alpha, 1 - slow)  # eqs. 9.9 and 9.10
                if signal.at_rest != "keep":
                    return high if signal.at_rest == "high" else low
                value = high if self._high[name] else low
                if value in (0.0, 1.0):
                    self._high[name] = value == 1.0
                return value
            case Switch():
                wanted = signal.levels[states.get(signal.key, 0)]
                if name not in before or not signal.fade_s:
                    return wanted
                most = passed_s / signal.fade_s
                return before[name] + min(max(wanted - before[name], -most), most)
            case Pulse():
                share = math.fmod(time_s, signal.period_s) / signal.period_s
                if signal.shape == "ramp":
                    return share
                if signal.shape == "square":
                    return float(share >= 0.5)
                return 0.5 - 0.5 * math.cos(math.tau * share)
            case Product():
                return math.prod(self._find(one, before) for one in signal.of)
            case Inverse():
                return 1 - self._find(signal.of, before)
        raise TypeError(signal)
