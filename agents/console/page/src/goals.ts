// Goals in the order in which the robot pursues them, in words, and asked for.
import type {Answer, Link} from './link';
import type {ActivitySchemas, Goal, GoalId, GoalStatus, SaphiraMap} from './types';

const acceptance = 3000;     // [ms] within which the intentions take up a goal
const look = 50;             // [ms]

export interface Pursued {
  id: string;
  status: GoalStatus;
  goal?: Goal;
  place: number;             // 1: in front; [0: it has ended, or does not drive]
}
export const ended = (status: GoalStatus) => !['GOAL_WAITING', 'GOAL_UNDERWAY', 'GOAL_SUSPENDED'].includes(status.state);

// The gateway's key of a goal is in hexadecimal digits.
export function isGoal(id: GoalId | undefined, key: string): boolean {
  const [writer, number] = key.split(':').map(digits => Number('0x' + digits));
  return id?.writer === writer && id.number === number;
}

// As commands and requests name it.
export const textOf = (key: string) => key.replace(/^0+/, '').replace(/:(.*)/, (_, digits) => `:${parseInt(digits, 16)}`);

// Open goals in the order in which the robot takes them up (priority, then age); ended ones, the newest first.
// A picture that is drawn between two frames from the gateway has them from the one before.
interface Pursuit { open: Pursued[]; over: Pursued[] }
let known: {link?: Link; heard: number; pursuit: Pursuit} = {heard: NaN, pursuit: {open: [], over: []}};
export function pursued(link: Link): Pursuit {
  if (known.link !== link || known.heard !== link.heard) known = {link, heard: link.heard, pursuit: order(link)};
  return known.pursuit;
}
function order(link: Link): Pursuit {
  const all = link.all<GoalStatus>('goals/status').map(([id, {data}]): Pursued => ({id, status: data, goal: link.goal(id), place: 0}));
  const accepted = (g: Pursued) => g.status.stamp.cycle - 10 * g.status.elapsed;
  const number = (g: Pursued) => parseInt(g.id.split(':')[1], 16);
  const age = (a: Pursued, b: Pursued) => Math.round(accepted(a) - accepted(b)) || number(a) - number(b);
  const underway = all.filter(g => g.status.state === 'GOAL_UNDERWAY');
  const waited = all.filter(g => !ended(g.status)).map(g => g.status.waits_for).find(id => id.writer > 0);
  const front = underway.length > 1 && waited ? underway.find(g => isGoal(waited, g.id)) : undefined;
  const rank = (g: Pursued) => g.status.state !== 'GOAL_UNDERWAY' ? 1 : !front || g === front ? 0 : 2;
  const open = all.filter(g => !ended(g.status))
    .sort((a, b) => rank(a) - rank(b) || (b.goal?.priority ?? 0) - (a.goal?.priority ?? 0) || age(a, b));
  // Another goal that is underway at the same time does not drive.
  let place = 0;
  for (const g of open) if (rank(g) < 2) g.place = ++place;
  return {open, over: all.filter(g => ended(g.status)).sort((a, b) => age(b, a))};
}

// The goals that a new one from here waits for.
export const ahead = (link: Link) => pursued(link).open.filter(g => g.place > 0 && (g.goal?.priority ?? 0) >= 0);

export function nameOf({status, goal}: {status: GoalStatus; goal?: Goal}): string {
  const first = goal?.arguments[0];
  const to = !first ? '' : first.kind === 'ARGUMENT_POINT' ? ` (${first.point.x.toFixed(1)}, ${first.point.y.toFixed(1)})`
    : first.kind === 'ARGUMENT_TEXT' && first.text.length < 20 ? ` ${first.text}` : '';
  return status.functor.replace(/[_-]/g, ' ') + to;
}

// In the words of the page where another goal is the reason, without its id. A refused change has its own reason.
const ownCodes = ['CODE_NONE', 'CODE_PREEMPTED'];
export function reasonOf(link: Link, {status, goal}: Pursued): string {
  const {open, over} = pursued(link);
  const other = ownCodes.includes(status.code) ? [...open, ...over].find(g => isGoal(status.waits_for, g.id)) : undefined;
  if (!other) return status.reason;
  const name = `"${nameOf(other)}" of ${other.status.requester || 'somebody'}`;
  if (ended(status)) return `stopped by ${name}`;
  const why = (other.goal?.priority ?? 0) > (goal?.priority ?? 0) ? 'is more important' : 'came first';
  return `${status.state === 'GOAL_WAITING' ? 'waits for' : 'interrupted by'} ${name}, which ${why}`;
}

// A value of several words, or with quotes, as the gateway reads it.
export const quoted = (text: string) => /[\s"]/.test(text) ? `"${text.replace(/["\\]/g, '\\$&')}"` : text;

// Words that ask for a place in short, where its name allows that.
const goTo = (place: string) => /^(?!to )[a-z][^\s"=]*( [^\s"=]+)*$/i.test(place) ? `go ${place}` : `go-to-place place=${quoted(place)}`;
const placeTypes = ['ARTIFACT_OFFICE', 'ARTIFACT_CORRIDOR', 'ARTIFACT_LANE', 'ARTIFACT_JUNCTION', 'ARTIFACT_POSITION'];   // the first ones are better examples

// What can be asked for: the places of the map, and the activities with the values that they need.
export interface Wishes { list: {words: string; about: string}[]; example: string }
let made: {map?: SaphiraMap; schemas?: ActivitySchemas; wishes: Wishes} | undefined;
export function wishes(link: Link): Wishes {
  const map = link.data<SaphiraMap>('map'), schemas = link.data<ActivitySchemas>('intentions/schemas');
  if (!made || made.map !== map || made.schemas !== schemas) made = {map, schemas, wishes: wishesOf(map, schemas)};
  return made.wishes;
}
function wishesOf(map?: SaphiraMap, schemas?: ActivitySchemas): Wishes {
  const named = (map?.artifacts ?? []).filter(a => a.name && placeTypes.includes(a.type))
    .sort((a, b) => placeTypes.indexOf(a.type) - placeTypes.indexOf(b.type));
  const places = [...new Set(named.map(a => a.name))].map(name => ({words: goTo(name), about: 'a place of the map'}));
  const activities = (schemas?.schemas ?? []).map(({name, summary, parameters}) =>
    ({words: [name, ...parameters.filter(p => p.required).map(p => `${p.name}=`)].join(' '), about: summary}));
  const example = `${places[0]?.words ?? 'go 3 1'}, turn to 90`;   // short, as the field is
  return {list: [...places, ...activities], example};
}

// The words that ask for the same again; nothing where words cannot say it.
export function wordsOf(goal?: Goal): string {
  if (!goal || goal.functor === 'stop') return '';
  const words = goal.arguments.map(({name, kind, number, text, point, frame}) =>
    kind === 'ARGUMENT_NUMBER' ? `${name}=${number}`
    : kind === 'ARGUMENT_POINT' ? `${name}=${point.x},${point.y},${point.th}@${frame.replace('FRAME_', '').toLowerCase()}`
    : kind === 'ARGUMENT_TEXT' && text ? `${name}=${quoted(text)}` : '');
  return words.includes('') ? '' : [goal.functor, ...words].join(' ');
}

// Asks for a goal, and ends others once the robot has accepted it: a refused one ends nothing.
export async function askGoal(link: Link, words: string, others: Pursued[]): Promise<Answer> {
  const answer = await link.ask({type: 'goal', words});
  if (!answer.well) return answer;
  const end = performance.now() + acceptance;
  let status: GoalStatus | undefined;
  while (!(status = link.get<GoalStatus>('goals/status', answer.id)?.data) && performance.now() < end)
    await new Promise(resolve => setTimeout(resolve, look));
  if (!status) return {...answer, well: false, text: 'Nobody has taken up the goal. See Programs.'};
  if (status.state === 'GOAL_REFUSED') return {...answer, well: false, text: status.reason};
  // The last ones first, so that none of them begins in between.
  for (const other of [...others].reverse()) {
    const ending = await link.ask({type: 'cancel', id: other.id});
    if (!ending.well) return ending;
  }
  return answer;
}
