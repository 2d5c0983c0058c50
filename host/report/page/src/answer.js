// The first screen: the answer, the figures, and what they rest on.
import { el, pairs } from './dom.js';
import { compared, integer, number, percent } from './format.js';

const COMMANDS = {
  error: 'Distance of a scan from a mesh', decimate: 'Reduction of a mesh',
  optimize: 'Mesh of a scan', verify: 'Check of a certificate' };

export const unit_of = (data) => data.unit ?? 'cloud’s unit';

function verdict_box({ within, text }) {
  const [kind, sign] = within === true ? ['yes', '✓'] : within === false ? ['no', '✗'] : ['open', 'i'];
  const [lead, ...rest] = text.split(/(?<=:) /);
  return el('p', { id: 'verdict', class: kind, role: 'status' },
    el('span', { class: 'sign', 'aria-hidden': 'true' }, sign),
    el('span', {}, rest.length > 0 ? [el('strong', {}, lead), ` ${rest.join(' ')}`] : el('strong', {}, lead)));
}

function figures(data) {
  const [e_max, back, epsilon] = compared([data.e_max, data.back], data.epsilon);
  const unit = data.unit ? ` ${data.unit}` : '';
  const relative = (value) => (data.width > 0 ? `${percent(value / data.width)} of the width` : null);
  const figure = (id, name, value, exact, note) => el('div', { class: 'figure', id },
    el('dt', {}, name),
    el('dd', {}, el('data', { value: exact, title: exact === null ? null : String(exact) }, value), note ? el('small', {}, note) : null));
  return el('dl', { id: 'figures' },
    data.epsilon === null ? null : figure('epsilon', 'Tolerance ε', epsilon + unit, data.epsilon, relative(data.epsilon)),
    figure('e_max', 'Maximum error e_max', e_max + unit, data.e_max, relative(data.e_max)),
    data.back === null ? null : figure('back', 'Mesh to reference', back + unit, data.back, relative(data.back)),
    figure('triangles', 'Triangles', integer(data.triangles), data.triangles),
    figure('points', 'Points', integer(data.points), data.points),
    figure('width', 'Width', number(data.width, 6) + unit, data.width, data.unit ? `all lengths in ${data.unit}` : 'all lengths in the cloud’s unit'));
}

function checks(list) {
  if (!list?.length) return null;
  return el('ul', { id: 'checks' }, list.map(({ claim, holds, text }) =>
    el('li', { class: holds ? 'yes' : 'no' }, el('strong', {}, holds ? 'yes: ' : 'no: '), text ?? claim)));
}

function folded(id, summary, ...content) {
  return el('details', { id }, el('summary', {}, summary), content);
}

function provenance(data) {
  return folded('provenance', 'Files, checksums and parameters',
    pairs('Files', [['program', data.program], ...(data.provenance ?? []).map(({ name, file, sha256 }) =>
      [name, [file, sha256 ? el('code', { class: 'sum' }, `SHA-256 ${sha256}`) : null]])]),
    data.parameters?.length
      ? [el('h3', {}, 'Parameters'), pairs('Parameters', data.parameters.map(({ name, text }) => [name, text]))] : null);
}

function certificate(data) {
  if (!data.certificate) return null;
  const { file, text, verify } = data.certificate;
  return folded('certificate', 'Certificate',
    el('p', {}, 'The certificate ', el('code', {}, file), ' was computed in double precision, rounded outward. This command recomputes it from the files:'),
    el('pre', { class: 'command' }, verify),
    el('pre', { class: 'text', tabindex: '0', role: 'region', 'aria-label': 'Text of the certificate' }, text));
}

/** Fills the header of the page. */
export function show_answer(data, header) {
  header.replaceChildren(...[
    el('p', { class: 'kind' }, COMMANDS[data.command] ?? data.command, el('span', { class: 'program' }, data.program)),
    el('h1', { id: 'title' }, data.title),
    verdict_box(data.verdict),
    checks(data.checks),
    figures(data),
    data.facts?.length
      ? folded('facts', `As emax ${data.command} prints it`, pairs('Facts', data.facts.map(({ name, text }) => [name, text]))) : null,
    provenance(data),
    certificate(data)].filter(Boolean));
}
