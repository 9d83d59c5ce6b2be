// Changes of the map, in the words of `saphira map`, and how to undo them.
import {degrees} from './geometry';
import type {Answer, Link} from './link';
import type {MapArtifact, Pose, SaphiraMap} from './types';

interface Point { x: number; y: number }
// Drawn by dragging over the map: a zone between two corners, or where the robot faces from a place on.
export interface Sketch { kind: 'zone' | 'facing'; rule: string; from: Point; to: Point }
interface Undo { text: string; puts: boolean; artifact: MapArtifact }

export const rules = {ZONE_KEEP_OUT: 'keep-out', ZONE_SLOW: 'slow', ZONE_ONE_WAY: 'one-way', ZONE_PREFERRED: 'preferred'};
export const ruleOf = (artifact: MapArtifact) => rules[artifact.rule as keyof typeof rules] ?? '';
const least = 0.1;           // [m] of a zone
const undos: Undo[] = [];    // of this page, the newest last

export const facing = ({from, to}: Sketch) => Math.atan2(to.y - from.y, to.x - from.x);

// A zone along the axes of the map; a one-way zone leads the way in which it was drawn.
export function zoneOf({rule, from, to}: Sketch, name = '', speed = 0): MapArtifact {
  const dx = to.x - from.x, dy = to.y - from.y, upright = Math.abs(dy) > Math.abs(dx);
  const th = rule !== 'ZONE_ONE_WAY' ? 0 : upright ? Math.sign(dy) * Math.PI / 2 : dx < 0 ? Math.PI : 0;
  const along = Math.max(least, Math.abs(dx)), across = Math.max(least, Math.abs(dy)), turned = rule === 'ZONE_ONE_WAY' && upright;
  return {id: 0, type: 'ARTIFACT_ZONE', pose_in_map: {x: (from.x + to.x) / 2, y: (from.y + to.y) / 2, th},
    length: turned ? across : along, width: turned ? along : across, name, learned: false, rule, speed};
}
export const placeOf = (at: Point, name: string): MapArtifact =>
  ({id: 0, type: 'ARTIFACT_POSITION', pose_in_map: {...at, th: 0}, length: 0, width: 0, name, learned: false, rule: '', speed: 0});

// The line of a map file [mm, degrees].
export function lineOf(a: MapArtifact): string {
  const mm = (meters: number) => Math.round(1000 * meters);
  const name = a.name ? ` "${a.name}"` : '';
  const pose = `(${a.id}) ${mm(a.pose_in_map.x)}, ${mm(a.pose_in_map.y)}, ${degrees(a.pose_in_map.th).toFixed(1)}`;
  if (a.type === 'ARTIFACT_POSITION') return `POS ${pose}${name}`;
  return `ZONE ${pose}, ${mm(a.length)}, ${mm(a.width)} ${ruleOf(a)}${a.rule === 'ZONE_SLOW' ? ` ${mm(a.speed)}` : ''}${name}`;
}
export const nameFor = (a: MapArtifact) => `${a.type === 'ARTIFACT_ZONE' ? `${ruleOf(a)} zone` : 'place'}${a.name ? ` ${a.name}` : ''}`;

const change = (link: Link, words: string) => link.ask({type: 'map', words});
const put = (a: MapArtifact) => `put "${lineOf(a).replace(/["\\]/g, '\\$&')}"`;

export async function add(link: Link, artifact: MapArtifact): Promise<Answer> {
  if (artifact.name.includes('"')) return {well: false, text: 'A name has no quotation marks: a map file cannot hold them.', id: ''};
  const ids = link.data<SaphiraMap>('map')?.artifacts.map(a => a.id) ?? [];
  const answer = await change(link, put({...artifact, id: 1 + Math.max(0, ...ids)}));
  if (answer.well) undos.push({text: `adding ${nameFor(artifact)}`, puts: false, artifact: {...artifact, id: Number(answer.id)}});
  return answer;
}
export async function remove(link: Link, artifact: MapArtifact): Promise<Answer> {
  const answer = await change(link, `remove ${artifact.id}`);
  if (answer.well) undos.push({text: `removing ${nameFor(artifact)}`, puts: true, artifact: {...artifact}});
  return answer;
}
export const toUndo = () => undos[undos.length - 1]?.text ?? '';
export async function undo(link: Link): Promise<Answer> {
  const last = undos[undos.length - 1], {puts, artifact: {id}} = last;
  const answer = await change(link, puts ? put(last.artifact) : `remove ${id}`);
  if (!answer.well) return answer;
  undos.splice(undos.indexOf(last), 1);
  // The id of what was removed is not used again.
  if (puts) for (const one of undos) if (one.artifact.id === id) one.artifact.id = Number(answer.id);
  return answer;
}
export const placeRobot = (link: Link, {x, y, th}: Pose) => change(link, `place ${x.toFixed(3)} ${y.toFixed(3)} ${th.toFixed(4)}`);

// The map as a file of this browser's machine.
export async function saveMap(link: Link) {
  const answer = await link.ask({type: 'save_map'});
  if (!answer.well || answer.file === undefined) return link.note(answer.text, false);
  const way = document.createElement('a'), name = (answer.id.split('/').pop() || 'robot').replace(/\.map$/, '');
  way.href = URL.createObjectURL(new Blob([answer.file], {type: 'text/plain'}));
  way.download = `${name}.map`;
  way.click();
  setTimeout(() => URL.revokeObjectURL(way.href), 10_000);
}
// In the place of the running map; a bad file changes nothing.
export async function loadMap(link: Link, file: File) {
  const answer = await link.sendFile('load_map', file.name, await file.text());
  if (answer.well) undos.length = 0;   // they were of the other map
  link.note(answer.well ? `The map is ${file.name} now.` : `${answer.text.split('\n')[0]}. The map stays as it was.`, answer.well);
}
