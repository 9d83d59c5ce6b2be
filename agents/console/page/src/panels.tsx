// Panels: goals, behaviors, intentions, programs and messages, in words and bars.
import {strangersIn} from './strangers';
import type {ComponentChildren} from 'preact';
import {useState} from 'preact/hooks';
import {degrees, heading} from './geometry';
import {ended, isGoal, nameOf, type Pursued, pursued, reasonOf, textOf, wishes, wordsOf} from './goals';
import type {Link} from './link';
import type {BehaviorState, Behaviors, Belief, Cause, Goal, Grant, IntentionNode, Intentions, LogRecord, Message, Processes, ProgramMind, ServiceStatus, Utterance, Why} from './types';
import {notifies, wantNotifications} from './notify';
import {clock, forPage, instanceWords, keyless, percent, seconds} from './words';

const stale = 2000;          // [ms] the status of an open goal comes each second
const word = (name: string) => name.replace(/^[A-Z]+_/, '').toLowerCase().replace(/_/g, ' ');
// link: the text is of the robot, so it is not known without a connection.
export const nothing = (text: string, link?: Link) =>
  <p class="nothing">{link && !link.isThere() ? 'Not known: there is no connection to the console.' : text}</p>;

// An SVG, since the page's security policy forbids styles in elements.
export function Bar({value, label}: {value: number; label: string}) {
  const v = Math.min(1, Math.max(0, value));
  return <svg class="bar" viewBox="0 0 100 6" preserveAspectRatio="none" role="img" aria-label={`${label}: ${percent(v)}`}>
    <rect class="bar-ground" width="100" height="6" rx="2" /><rect class="bar-full" width={100 * v} height="6" rx="2" />
  </svg>;
}
// To one side of the middle: left and right, or back and ahead; how much it counts by its height. Below it the
// same in numbers.
function Channel({value, weight, label, text}: {value: number; weight: number; label: string; text: string}) {
  const v = Math.min(1, Math.max(-1, value)), h = 3 + 9 * Math.min(1, Math.max(0, weight));
  return <><svg class="channel" viewBox="0 0 80 14" preserveAspectRatio="none" role="img" aria-label={label}>
    <rect class="bar-ground" x="0" y="6" width="80" height="2" />
    <rect class="bar-full" x={v < 0 ? 40 + 40 * v : 40} y={7 - h / 2} width={40 * Math.abs(v)} height={h} />
    <rect class="bar-middle" x="39.5" y="0" width="1" height="14" />
  </svg><span class="figures">{text}</span></>;
}
// A weight is of the blend [undefined: the blend itself].
function Turn({says, turn, weight}: {says: boolean; turn: number; weight?: number}) {
  const size = Math.abs(degrees(turn)).toFixed(0);
  const text = !says ? 'no turn' : (size === '0' ? 'straight' : `${turn > 0 ? 'left' : 'right'} ${size}°`) + share(weight);
  return <Channel value={says ? -turn / 0.6 : 0} weight={weight ?? 0.6} label={`turn: ${text}`} text={text} />;
}
function Speed({says, speed, weight}: {says: boolean; speed: number; weight?: number}) {
  const text = !says ? 'no speed' : `${speed.toFixed(2)} m/s${share(weight)}`;
  return <Channel value={says ? speed / 0.4 : 0} weight={weight ?? 0.6} label={`speed: ${text}`} text={text} />;
}
const share = (weight?: number) => weight === undefined ? '' : `, ${percent(weight)}`;

export function Goals({link, now}: {link: Link; now: number}) {
  const [words, setWords] = useState('');
  const [told, setTold] = useState<{text: string; well: boolean}>();
  const send = async (event: Event) => {
    event.preventDefault();
    if (!words.trim()) return;
    const answer = await link.ask({type: 'goal', words});
    setTold(answer.well ? undefined : answer);
    if (answer.well) setWords('');
  };
  const {open, over} = pursued(link);
  const {list, example} = wishes(link);
  const many = open.some(g => g.place > 1);
  const why = link.mayDrive ? undefined : keyless;
  return <>
    <form class="ask" onSubmit={send}>
      <label for="goal-words">Ask the robot for something</label>
      <div class="row">
        <input id="goal-words" value={words} disabled={!link.mayDrive} title={why} autocomplete="off" spellcheck={false}
               placeholder={example} list="goal-wishes"
               onInput={e => setWords((e.target as HTMLInputElement).value)} />
        <datalist id="goal-wishes">{list.map(({words, about}) => <option key={words} value={words} label={about} />)}</datalist>
        <button type="submit" disabled={!link.mayDrive} title={why}>Send</button>
        <button type="button" disabled={!link.mayDrive} title={why ?? 'ends every goal that drives, of everybody'} onClick={() => link.ask({type: 'goal', words: 'stop'}).then(answer => setTold(answer.well ? undefined : answer))}>End all</button>
      </div>
      {told && <p class={told.well ? 'told' : 'told bad'} role="status">{forPage(told.text)}</p>}
    </form>
    {open.length + over.length === 0 && nothing('No goal is underway. Click on the map to send the robot somewhere.', link)}
    {many && <h2>One goal after the other, in this order</h2>}
    <ol class="cards" aria-label="Goals">{open.map(g => <GoalCard key={g.id} pursued={g} many={many} link={link} now={now} />)}</ol>
    {over.length > 0 && <h2>Ended</h2>}
    <ul class="cards" aria-label="Ended goals">{over.map(g => <GoalCard key={g.id} pursued={g} many={false} link={link} now={now} />)}</ul>
  </>;
}
const orderWords = ['', 'in front', 'next'];
function argumentsOf(goal?: Goal): string {
  return (goal?.arguments ?? []).map(a => {
    if (a.kind === 'ARGUMENT_POINT') return `${a.name} (${a.point.x.toFixed(1)}, ${a.point.y.toFixed(1)})`;
    return `${a.name} ${a.kind === 'ARGUMENT_TEXT' ? a.text : a.name === 'facing' ? `${heading(a.number)}°` : +a.number.toFixed(2)}`;
  }).join(', ');
}
function GoalCard({pursued: self, many, link, now}: {pursued: Pursued; many: boolean; link: Link; now: number}) {
  const {id, status, goal, place} = self;
  const [told, setTold] = useState('');
  const over = ended(status);
  const grant = link.data<Grant>('drive/grant');
  const held = over || status.state !== 'GOAL_UNDERWAY' ? '' : grant?.role === 'ROLE_TELEOP' ? 'a person drives'
    : grant?.waits_for_hand_back ? 'waits for Hand back' : '';
  const age = over ? 0 : now - (link.get('goals/status', id)?.at ?? now);
  const words = over && link.mayDrive ? wordsOf(goal) : '';
  const name = nameOf({status, goal});
  const approve = () => processAsk(link, 'intentions', textOf(id), 'resume', `Approve ${name}`);
  const again = () => link.ask({type: 'goal', words}).then(answer => setTold(answer.well ? '' : answer.text));
  return <li class={over ? 'card over' : 'card'}>
    <div class="row top">
      <div class="row grow"><strong class={many ? 'line' : ''}>{many && place > 0 && `${place}. `}{name}</strong>
        {many && place > 0 && <span class="chip">{orderWords[place] ?? `place ${place}`}</span>}
        <span class={`chip ${status.state.toLowerCase()}`}>{word(status.state)}</span>
        {held && <span class="chip warn">{held}</span>}
        {age > stale && <span class="chip warn">{seconds(age)} ago</span>}</div>
      {status.code === 'CODE_APPROVAL' && link.mayOperate && <button class="main" onClick={approve} aria-label={`Approve ${name}`}>Approve</button>}
      {!over && link.mayDrive && <button onClick={() => link.ask({type: 'cancel', id})} aria-label={`Cancel ${name}`}>Cancel</button>}
      {words && <button title="the same goal once more" aria-label={`Ask again: ${name}`} onClick={again}>Ask again</button>}
    </div>
    {goal && <div class="small">{argumentsOf(goal)}</div>}
    {!over && <div class="progress"><Bar value={status.progress} label="progress" /><span class="small">{percent(status.progress)}</span></div>}
    <div class="small">{forPage(reasonOf(link, self)) || status.step}{status.note && ` (${status.note})`}</div>
    {told && <p class="told bad" role="status">{told}</p>}
    <div class="small faint">by {status.requester}, {status.elapsed.toFixed(0)} s</div>
  </li>;
}

// Programs with behaviors of their own, until 2 s after their newest sample.
function OfPrograms({link, now, show}: {link: Link; now: number; show: (mind: ProgramMind) => ComponentChildren}) {
  return <>{link.all<ProgramMind>('programs/mind').filter(([, item]) => now - item.at < 2000).map(([key, {data}]) =>
    <section key={key}><h2>Of the program {data.source}</h2>{show(data)}</section>)}</>;
}

export function BehaviorList({link, now}: {link: Link; now: number}) {
  const state = link.data<Behaviors>('behaviors/state');
  return <>
    {state ? <BehaviorTable state={state} link={link} />
      : nothing('The program "behaviors" is silent. See Programs.', link)}
    <OfPrograms link={link} now={now} show={mind => <BehaviorTable state={mind.behaviors} />} />
  </>;
}
// link: of the robot's own behaviors, which are switched (manual 2.3.6). One that is off is not in the blend: the tree of intentions has it.
function BehaviorTable({state, link}: {state: Behaviors; link?: Link}) {
  const [open, setOpen] = useState('');
  const nodes = link?.data<Intentions>('intentions')?.nodes ?? [];
  const off = nodes.filter(n => n.label === 'B' && n.state === 'INTENTION_SUSPENDED' && !state.behaviors.some(b => b.name.endsWith(`#${n.id}`)));
  const holder = (n: IntentionNode) => nodes.find(p => p.id === n.parent && isHeld(p));
  const may = link?.mayOperate;
  const alone = (b: BehaviorState) => state.behaviors.every(other => other === b || other.schema !== b.schema);
  return <>
    {!state.control && <p class="told bad">Behavior control is off: the blend does not reach the robot.</p>}
    {state.trouble && <p class="told bad">{state.trouble}</p>}
    {state.behaviors.length + off.length === 0 && nothing('No behavior is intended: the robot has no goal.', link)}
    {state.behaviors.length + off.length > 0 && <table class="behaviors">
      <thead><tr><th scope="col">{may && 'On, '}Behavior</th><th scope="col">Turn, weight</th><th scope="col">Speed, weight</th></tr></thead>
      <tbody>{state.behaviors.map(b => <BehaviorRow key={b.name} b={b} name={alone(b) ? b.schema : instanceWords(b.name)} open={open === b.name} toggle={() => setOpen(open === b.name ? '' : b.name)}
        onOff={may && <Switch link={link!} id={b.name.split('#')[1]} name={b.schema} on />} />)}
        {off.map(n => <tr key={n.id} class="faint"><th scope="row"><div class="on">{may && <Switch link={link!} id={`${n.id}`} name={n.schema} on={false} held={holder(n)?.schema} />}{n.schema}</div></th><td colSpan={2} class="small">{holder(n) ? `held with ${holder(n)!.schema}` : 'off: it is left out until somebody switches it on'}</td></tr>)}</tbody>
      <tfoot><tr><th scope="row">Together</th>
        <td><Turn says={state.turning} turn={state.turn} /></td>
        <td><Speed says={state.moving} speed={state.speed} /></td></tr></tfoot>
    </table>}
    {state.limit_reason && <p class="small">{forPage(state.limit_reason)}</p>}
    {state.missing.map(m => <p class="told bad" key={m.name}>{instanceWords(m.name)}: {m.reason}</p>)}
  </>;
}
function Switch({link, id, name, on, held}: {link: Link; id: string; name: string; on: boolean; held?: string}) {
  return <input type="checkbox" role="switch" checked={on} disabled={!!held} aria-label={`${name} on`} onClick={event => {
    event.preventDefault();   // the robot decides
    processAsk(link, 'intentions', `I${id}`, on ? 'interrupt' : 'resume', `${name} ${on ? 'off' : 'on'}`);
  }} />;
}
function BehaviorRow({b, name, open, toggle, onOff}: {b: BehaviorState; name: string; open: boolean; toggle: () => void; onOff: ComponentChildren}) {
  return <>
    <tr class={b.running ? '' : 'faint'}>
      <th scope="row"><div class="on">{onOff}<button class="plain" aria-expanded={open} onClick={toggle}>
        <span class="twist" aria-hidden="true">{open ? '▾' : '▸'}</span>{name}</button></div></th>
      <td><Turn says={b.recommends_turn} turn={b.turn} weight={b.turn_weight} /></td>
      <td><Speed says={b.recommends_speed} speed={b.speed} weight={b.speed_weight} /></td>
    </tr>
    {open && <tr class="rules"><td colSpan={3}>
      <p class="small">{instanceWords(b.name)}, priority {b.priority}{b.running ? '' : ', not running'}; goal {percent(b.goal)}, progress {percent(b.progress)}</p>
      <ul>{b.rules.map(r => <li key={r.name} class="rule"><span>{r.name}</span><Bar value={r.strength} label={`strength of ${r.name}`} />
        <span class="small">{percent(r.strength)}</span><span class="small">{ruleText(r.action, r.value)}</span></li>)}</ul>
    </td></tr>}
  </>;
}
function ruleText(action: string, value: number): string {
  switch (action) {
    case 'CONTROL_TURN_LEFT': return `left ${degrees(value).toFixed(0)}°`;
    case 'CONTROL_TURN_RIGHT': return `right ${degrees(value).toFixed(0)}°`;
    case 'CONTROL_ACCELERATE': return `+${value.toFixed(2)} m/s`;
    case 'CONTROL_DECELERATE': return `−${value.toFixed(2)} m/s`;
    default: return `${value.toFixed(2)} m/s`;
  }
}

export function IntentionTree({link, now}: {link: Link; now: number}) {
  const intentions = link.data<Intentions>('intentions');
  return <>
    {intentions ? <Tree intentions={intentions} link={link} />
      : nothing('The program "intentions" is silent. See Programs.', link)}
    <OfPrograms link={link} now={now} show={mind => <Tree intentions={mind.intended} />} />
  </>;
}
const isHeld = (node: IntentionNode) => node.state === 'INTENTION_INTERRUPTED' || node.state === 'INTENTION_SUSPENDED';
// link: of the robot's own intentions, which can be interrupted.
function Tree({intentions, link}: {intentions: Intentions; link?: Link}) {
  if (intentions.nodes.length === 0) return nothing('The robot intends nothing: it has no goal.', link);
  const depths = new Map<number, number>();
  // The goal in front holds these: nobody can resume them.
  const preempted = link ? pursued(link).open.filter(g => g.status.state === 'GOAL_SUSPENDED') : [];
  // All that a held intention has begun goes with that; behaviors (B) are switched in their own table.
  const resting = new Set<number>();
  const canAct = (node: IntentionNode) => link?.mayOperate && node.label !== 'B' && !resting.has(node.parent) && !preempted.some(g => isGoal(node.goal, g.id));
  return <><ul class="intentions">{intentions.nodes.map(node => {
    const depth = Math.min(8, (depths.get(node.parent) ?? -1) + 1);
    depths.set(node.id, depth);
    const held = isHeld(node);
    const button = link && canAct(node);
    if (held || resting.has(node.parent)) resting.add(node.id);
    return <li key={node.id} class={`depth-${depth} row`}><div class="grow">
      <div><span class="marker" title={node.blocking ? 'its parent waits for it' : 'its parent goes on'}>{node.blocking ? '∗' : '○'}</span>
        <strong>{node.schema}</strong> {node.name !== node.schema && <span class="faint">{instanceWords(node.name)}</span>} <span class="chip">{node.label && !held ? `then ${node.label}` : word(node.state)}</span></div>
      {node.step && <div class="small">{node.step}</div>}
      {node.arguments && <div class="small faint">{node.arguments}</div>}</div>
      {button && <Interrupt link={link} service="intentions" process={`I${node.id}`} name={node.schema} held={held} />}
    </li>;
  })}</ul>
  {link && <p class="small faint">Interrupt holds an intention and all that it has begun, until Resume. Single behaviors are switched in Behaviors.</p>}</>;
}
// A micro-task or an intention: held, or let go on.
function Interrupt({link, service, process, name, held}: {link: Link; service: string; process: string; name: string; held: boolean}) {
  const functor = held ? 'resume' : 'interrupt', label = held ? 'Resume' : 'Interrupt';
  return <button aria-label={`${label} ${name}`} onClick={() => processAsk(link, service, process, functor, `${label} ${name}`)}>{label}</button>;
}
function processAsk(link: Link, service: string, process: string, functor: string, what: string) {
  void link.ask({type: 'process', service, process, functor})
    .then(answer => link.note(`${what}: ${answer.text || (answer.well ? 'done' : 'refused')}`, answer.well));
}

export function WhyTree({link}: {link: Link}) {
  const why = link.data<Why>('why');
  const beliefs = link.data<{beliefs: Belief[]}>('beliefs')?.beliefs ?? [];
  if (!why) return nothing('No cycle of the robot has been heard yet.', link);
  return <>
    <ul class="why"><Because cause={why.tree} depth={0} /></ul>
    <details class="beliefs"><summary>Beliefs of the activities ({beliefs.length})</summary>
      <table><tbody>{beliefs.map(b => <tr key={b.name}><th scope="row">{b.name}</th><td>{b.value}</td><td class="faint">{b.said_by}</td></tr>)}</tbody></table>
    </details>
  </>;
}
function Because({cause, depth}: {cause: Cause; depth: number}) {
  const text = <><span class="kind">{cause.kind}</span> {forPage(cause.text)}</>;
  if (cause.because.length === 0) return <li><span class="leaf">{text}</span></li>;
  return <li><details open={depth < 2}><summary>{text}</summary>
    <ul>{cause.because.map((c, i) => <Because key={c.kind + i} cause={c} depth={depth + 1} />)}</ul></details></li>;
}

// The strangers that are kept out: their addresses, and from the log the names that they gave; and members who
// try what they may not.
function KeptOut({link}: {link: Link}) {
  const strangers = strangersIn(link.all<ServiceStatus>('system/status').map(([, {data}]) => data));
  const refused = link.all<LogRecord>('system/log').filter(([, {data}]) => / is not let in | are kept out: | is refused: .* may not /.test(data.text));
  if (strangers.length + refused.length === 0) return null;
  return <div class="told bad" role="alert"><strong>Kept out of the bus</strong>
    <ul class="lines">{strangers.map(s => <li key={s.address}>{s.address}: {s.packets} packets in {s.during} s, the last {s.ago} s ago; heard by {s.by.join(', ')}</li>)}
      {refused.map(([key, {data}]) => <li key={key}><time class="faint">{clock(data.time_ns / 1e6)}</time><span><span class="faint">{data.name}</span> {data.text}</span></li>)}</ul>
  </div>;
}

export function Programs({link, now}: {link: Link; now: number}) {
  const programs = link.all<ServiceStatus>('system/status').sort((a, b) => a[1].data.name.localeCompare(b[1].data.name));
  const services = link.all<Processes>('processes').sort((a, b) => a[1].data.service.localeCompare(b[1].data.service));
  return <>
    <KeptOut link={link} />
    <table class="programs"><thead><tr><th scope="col">Program</th><th scope="col">State</th><th scope="col" class="number">Load</th>
      <th scope="col" class="number">Step</th><th scope="col" class="number">Age</th></tr></thead>
      <tbody>{programs.map(([key, {data, at}]) => {
        const age = (now - at) / 1000, lost = age > 3;
        const state = lost ? 'lost' : word(data.state);
        return <><tr key={key} class={lost ? 'bad' : ''}><th scope="row">{data.name}</th>
          <td><span class={`chip ${lost || state === 'degraded' ? 'bad' : state === 'running' ? 'good' : ''}`}>{state}</span></td>
          <td class="number">{data.cpu_percent.toFixed(1)} %</td><td class="number">{data.step_ms_mean > 0 ? `${data.step_ms_mean.toFixed(1)} ms` : ''}</td>
          <td class="number">{age.toFixed(0)} s</td></tr>
          {data.reason && <tr key={key + 'r'}><td colSpan={5} class="small reason">{forPage(data.reason)}</td></tr>}</>;
      })}</tbody></table>
    {programs.length === 0 && nothing('No program is on the bus.', link)}
    <h2>Micro-tasks: interrupt and resume</h2>
    <p class="small">A micro-task is a part of a service that runs in each cycle. Interrupt holds it until Resume.
      {link.mayOperate ? '' : ' Both need a key to operate.'}</p>
    {services.map(([key, {data}]) => <details key={key}><summary>{data.service} ({data.processes.length})</summary>
      <ul class="processes">{data.processes.map(p => {
        const held = p.state === 'PROCESS_SUSPENDED' || p.state === 'PROCESS_INTERRUPTED';
        return <li key={p.name} class="row"><span class="grow"><strong>{instanceWords(p.name)}</strong> <span class="chip">{word(p.state)}</span><br />
          <span class="small faint">{p.effect}</span></span>
          {link.mayOperate && <Interrupt link={link} service={data.service} process={p.name} name={p.name} held={held} />}</li>;
      })}</ul></details>)}
  </>;
}

export function Messages({link}: {link: Link}) {
  const [all, setAll] = useState(false);
  const [words, setWords] = useState('');
  const [told, setTold] = useState(notifies());
  const say = (event: Event) => {
    event.preventDefault();
    if (words.trim() && link.send({type: 'say', text: words.trim()})) setWords('');
  };
  // By the clock of the writer where the sample has a time, else as it was heard.
  const heardAt = (at: number) => Date.now() - performance.now() + at;
  const messages = link.all<Message>('messages').map(([key, {data, at}]) => ({key, at: heardAt(at), from: data.source, text: data.text, level: 'message'}));
  const log = link.all<LogRecord>('system/log').map(([key, {data, at}]) => ({key, at: data.time_ns > 0 ? data.time_ns / 1e6 : heardAt(at), from: data.name, text: data.text, level: word(data.level)}))
    .filter(l => all || l.level === 'warning' || l.level === 'error');
  const saidAt = (utterance: Utterance, at: number) => utterance.time > 0 ? 1000 * utterance.time : heardAt(at);
  const said = link.all<Utterance>('utterances/said').map(([key, {data, at}]) => ({key, at: saidAt(data, at), from: 'robot', text: data.text, level: 'message'}));
  const heard = link.all<Utterance>('utterances/heard').map(([key, {data, at}]) => ({key, at: saidAt(data, at), from: data.speaker || 'somebody', text: data.text, level: 'message'}));
  const lines = [...messages, ...said, ...heard, ...log].sort((a, b) => b.at - a.at || b.key.localeCompare(a.key));
  const why = link.mayDrive ? undefined : keyless;
  const understood = link.all<ServiceStatus>('system/status').some(([, {data}]) => data.name === 'dialogue');
  return <>
    <form class="ask" onSubmit={say}>
      <label for="say">Say something to the robot</label>
      <div class="row"><input id="say" value={words} disabled={!link.mayDrive} title={why} autocomplete="off"
                              onInput={e => setWords((e.target as HTMLInputElement).value)} />
        <button type="submit" disabled={!link.mayDrive} title={why}>Say</button></div>
      {!understood && <p class="small">No program here understands speech: the tab Goals takes goals in words.</p>}
    </form>
    <label class="check"><input type="checkbox" checked={all} onChange={e => setAll((e.target as HTMLInputElement).checked)} /> everything that programs log</label>
    {told !== undefined && <label class="check"><input type="checkbox" checked={told} onChange={async e => setTold(await wantNotifications((e.target as HTMLInputElement).checked))} /> tell me of stops, failures and a low battery while I look elsewhere</label>}
    {lines.length === 0 && nothing('No messages, and no warnings.', link)}
    <ul class="lines" aria-live="polite">{lines.map(l => <li key={l.key} class={l.level}><time class="faint">{clock(l.at)}</time>
      <span><span class="faint">{l.from}</span> {forPage(l.text)}</span></li>)}</ul>
  </>;
}
