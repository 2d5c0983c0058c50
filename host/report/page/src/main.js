import { show_answer } from './answer.js';
import { el } from './dom.js';
import { read_geometry } from './geometry.js';
import { show_panel } from './panel.js';
import { Scale } from './scale.js';
import { show_sections } from './sections.js';
import { View } from './view.js';

const by_id = (id) => document.getElementById(id);

const notice = (text) => el('p', { class: 'notice', role: 'alert' }, text);

/** The data of the report; null where they cannot be read. */
function read_data() {
  try {
    const data = JSON.parse(by_id('emax-data').textContent);
    return data.schema === 'emax-report-1' ? data : null;
  } catch {
    return null;
  }
}

/** The view, or a sentence that says why there is none: then the picture stays. */
async function make_view(data, scale, stage) {
  let geometry;
  try {
    geometry = await read_geometry(by_id('emax-geometry'), data.geometry);
  } catch (error) {
    return `The geometry of this report cannot be read (${error.message}). The picture stays; the numbers are not affected.`;
  }
  try {
    return new View(stage, data, geometry, scale);
  } catch {
    stage.querySelector('canvas')?.remove();
    return 'This browser shows no WebGL, so the view in three dimensions is left out. The picture stays.';
  }
}

// On paper, what is folded on the screen is open and stands at the end.
function unfold_for_print() {
  let folded = [];
  addEventListener('beforeprint', () => {
    const all = [...document.querySelectorAll('#answer details')];
    folded = all.filter((details) => !details.open);
    for (const details of folded) details.open = true;
    by_id('sections').append(...all);
  });
  addEventListener('afterprint', () => {
    by_id('answer').append(...document.querySelectorAll('#sections details'));
    for (const details of folded) details.open = false;
  });
}

async function main() {
  const data = read_data();
  const stage = by_id('stage');
  if (!data) {
    by_id('answer').append(notice('The data of this report are damaged. Make the report anew.'));
    return;
  }
  document.title = `${data.title}: emax report`;
  const scale = new Scale(data);
  show_answer(data, by_id('answer'));
  unfold_for_print();
  by_id('footer').textContent = `Made by ${data.program}.`;

  const view = await make_view(data, scale, stage);
  let go = null;
  if (typeof view === 'string') {
    stage.before(notice(view));
  } else {
    stage.classList.add('live');
    view.resize();
    view.look('isometric');
    go = show_panel(view, data, scale, by_id('model'), stage);
    view.canvas.addEventListener('webglcontextlost', () => {
      stage.classList.remove('live');
      stage.before(notice('The browser ended the view; the picture stays. Load the page again for the view.'));
    });
    window.emax_view = view; // for the console and for tests
  }
  show_sections(data, scale, go, by_id('sections'));
  document.documentElement.dataset.ready = 'true';
}

main();
