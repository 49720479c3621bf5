"""Samples that jsPsych itself writes, in a browser, by its own simulation of the answers given.

Run `npm install jspsych @jspsych/plugin-survey-text @jspsych/plugin-html-keyboard-response
@jspsych/plugin-html-slider-response` in a folder, and then
`python docs/mappings/making/jspsych_samples.py FOLDER`.
"""

import json
import shutil
import sys
from pathlib import Path

from done import HERE, PRACTICE, letters, questions
from playwright.sync_api import sync_playwright

PLUGINS = ("survey-text", "html-keyboard-response", "html-slider-response")
RUN = Path(__file__).with_name("jspsych_samples.js").read_text(encoding="utf-8")


def simulated(plugin, response, rt_s, **told):
    """A trial, with the answer that jsPsych's simulation gives."""
    return {"plugin": plugin, "response": response, "rt": round(float(rt_s) * 1000), "data": told}


def read_letters(who, trials):
    """Strings, after two of practice; the answer is typed."""
    asked = [("practice", s, "0", s, rt) for s, rt in PRACTICE]
    asked += [("read", t["string"], t["texture"], t["answer"], t["rt"]) for t in trials]
    timeline = [simulated("html-keyboard-response", " ", 0.812, participant=who)]
    for task, string, texture, answer, rt in asked:
        told = {"participant": who, "task": task, "string": string, "texture": int(texture)}
        timeline.append(simulated("survey-text", {"answer": answer}, rt, **told))
    numbers = [*range(1, len(PRACTICE) + 1), *range(1, len(trials) + 1)]
    for trial, number in zip(timeline[1:], numbers, strict=True):
        trial["data"]["number"] = number
    return timeline


def ask(who, trials):
    """Questions of all kinds: keys, sliders and text; how sure it is is a trial of its own."""
    timeline = []
    for number, trial in enumerate(trials, 1):
        told = {n: trial[n] for n in ("task", "shown", "first", "second") if trial[n] != ""}
        told |= {"participant": who, "number": number, "part": "answer"}
        if trial["texture"] != "":
            told["texture"] = float(trial["texture"])
        if trial["right"] != "":
            told["right_key"] = trial["right"] == "1"
        answer = trial["answer"]
        if trial["task"] == "rating":
            timeline.append(simulated("html-slider-response", int(answer), 2, **told))
        elif trial["task"] in ("magnitude", "free"):
            timeline.append(simulated("survey-text", {"answer": answer}, 5, **told))
        else:
            timeline.append(simulated("html-keyboard-response", answer, 1, **told))
            sure = {"participant": who, "number": number, "part": "sure"}
            timeline.append(simulated("html-slider-response", int(trial["sure"]), 1, **sure))
    return timeline


def main(folder):
    """Write all samples."""
    modules = Path(folder, "node_modules")
    scripts = [modules / "jspsych" / "dist" / "index.browser.min.js"]
    scripts += [
        modules / "@jspsych" / f"plugin-{name}" / "dist" / "index.browser.min.js"
        for name in PLUGINS
    ]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        for name, people, make in (
            ("letters", letters(), read_letters),
            ("questions", questions(), ask),
        ):
            for (who, trials), form in zip(people.items(), ("json", "csv"), strict=True):
                page = browser.new_page()
                page.set_content("<!DOCTYPE html><body></body>")
                for script in scripts:
                    page.add_script_tag(path=script)
                page.add_script_tag(content=RUN)
                page.evaluate(f"run({json.dumps(make(who, trials))})")
                page.wait_for_function("window.exported")
                text = page.evaluate(f"exported.{form}")
                (HERE / f"jspsych-{name}-{who}.{form}").write_text(text, encoding="utf-8")
                print(page.evaluate("exported.version"))
                page.close()
        browser.close()


main(*sys.argv[1:])
