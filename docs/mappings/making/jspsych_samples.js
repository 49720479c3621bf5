// An experiment whose answers jsPsych's own simulation gives, and its data as jsPsych writes them.

const kinds = {
  "survey-text": jsPsychSurveyText,
  "html-keyboard-response": jsPsychHtmlKeyboardResponse,
  "html-slider-response": jsPsychHtmlSliderResponse,
};

async function run(trials) {
  const jsPsych = initJsPsych();
  const timeline = trials.map((trial) => ({
    type: kinds[trial.plugin],
    stimulus: "Read.",
    questions: [{ prompt: "What was it?", name: "answer" }],
    data: trial.data,
    simulation_options: { data: { rt: trial.rt, response: trial.response } },
    on_finish(data) {
      if (data.part === "answer") {
        data.answer = data.response.answer ?? data.response;
        if (data.right_key !== undefined) data.correct = data.right_key;
        delete data.right_key;
      } else if (data.part === "sure") {
        // How sure it is stands with the answer, too.
        jsPsych.data.get().filter({ part: "answer", number: data.number })
          .addToAll({ confidence: data.response });
      }
    },
  }));
  await jsPsych.simulate(timeline, "data-only");
  window.exported = {
    json: jsPsych.data.get().json(true),
    csv: jsPsych.data.get().csv(),
    version: jsPsych.version(),
  };
}
