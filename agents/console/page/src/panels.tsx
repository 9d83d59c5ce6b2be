// Panels: goals, behaviors, intentions, programs and messages, in words and bars.
import type {ComponentChildren} from 'preact';
import {useState} from 'preact/hooks';
import {degrees} from './geometry';
import type {Link} from './link';
import type {BehaviorState, Behaviors, Belief, Cause, Goal, GoalStatus, Grant, Intentions, LogRecord, Message, Processes, ProgramMind, ServiceStatus, Utterance, Why} from './types';

const word = (name: string) => name.replace(/^[A-Z]+_/, '').toLowerCase().replace(/_/g, ' ');
export const nothing = (text: string) => <p class="nothing">{text}</p>;
const percent = (value: number) => `${Math.round(100 * Math.min(1, Math.max(0, value)))}%`;

// An SVG, since the page's security policy forbids styles in elements.
export function Bar({value, label}: {value: number; label: string}) {
  const v = Math.min(1, Math.max(0, value));
  return <svg class="bar" viewBox="0 0 100 6" preserveAspectRatio="none" role="img" aria-label={`${label}: ${percent(v)}`}>
    <rect class="bar-ground" width="100" height="6" rx="2" /><rect class="bar-full" width={100 * v} height="6" rx="2" />
  </svg>;
}
// To one side of the middle: left and right, or back and ahead; how much it counts by its height.
function Channel({value, weight, label}: {value: number; weight: number; label: string}) {
  const v = Math.min(1, Math.max(-1, value)), h = 3 + 9 * Math.min(1, Math.max(0, weight));
  return <svg class="channel" viewBox="0 0 80 14" preserveAspectRatio="none" role="img" aria-label={label}>
    <rect class="bar-ground" x="0" y="6" width="80" height="2" />
    <rect class="bar-full" x={v < 0 ? 40 + 40 * v : 40} y={7 - h / 2} width={40 * Math.abs(v)} height={h} />
    <rect class="bar-middle" x="39.5" y="0" width="1" height="14" />
  </svg>;
}

export function Goals({link}: {link: Link}) {
  const [words, setWords] = useState('');
  const [told, setTold] = useState<{text: string; well: boolean}>();
  const send = async (event: Event) => {
    event.preventDefault();
    if (!words.trim()) return;
    const answer = await link.ask({type: 'goal', words});
    setTold(answer.well ? undefined : answer);
    if (answer.well) setWords('');
  };
  const goals = link.all<GoalStatus>('goals/status').sort((a, b) => rank(a[1].data) - rank(b[1].data) || a[1].data.elapsed - b[1].data.elapsed);
  const asked = new Map(link.all<Goal>('goals').map(([key, item]) => [key, item.data]));
  return <>
    <form class="ask" onSubmit={send}>
      <label for="goal-words">Ask the robot for something</label>
      <div class="row">
        <input id="goal-words" value={words} disabled={!link.mayDrive} autocomplete="off" spellcheck={false}
               placeholder="go EJ-231, go 3 1, turn 90, patrol"
               onInput={e => setWords((e.target as HTMLInputElement).value)} />
        <button type="submit" disabled={!link.mayDrive}>Send</button>
        <button type="button" disabled={!link.mayDrive} onClick={() => link.ask({type: 'goal', words: 'stop'}).then(setTold)}>End all</button>
      </div>
      {told && <p class={told.well ? 'told' : 'told bad'} role="status">{told.text}</p>}
    </form>
    {goals.length === 0 && nothing('No goals. Click on the map to send the robot somewhere.')}
    <ul class="cards">{goals.map(([key, {data}]) => <GoalCard key={key} id={key} status={data} goal={asked.get(key)} link={link} />)}</ul>
  </>;
}
const rank = (status: GoalStatus) => status.state === 'GOAL_UNDERWAY' ? 0 : ended(status) ? 2 : 1;
const ended = (status: GoalStatus) => !['GOAL_WAITING', 'GOAL_UNDERWAY', 'GOAL_SUSPENDED'].includes(status.state);
function argumentsOf(goal?: Goal): string {
  return (goal?.arguments ?? []).map(a => {
    if (a.kind === 'ARGUMENT_POINT') return `${a.name} (${a.point.x.toFixed(1)}, ${a.point.y.toFixed(1)})`;
    return `${a.name} ${a.kind === 'ARGUMENT_TEXT' ? a.text : +a.number.toFixed(2)}`;
  }).join(', ');
}
function GoalCard({id, status, goal, link}: {id: string; status: GoalStatus; goal?: Goal; link: Link}) {
  const over = ended(status);
  const grant = link.data<Grant>('drive/grant');
  const held = over || status.state !== 'GOAL_UNDERWAY' ? '' : grant?.role === 'ROLE_TELEOP' ? 'a person drives'
    : grant?.waits_for_hand_back ? 'waits for Hand back' : '';
  return <li class={over ? 'card over' : 'card'}>
    <div class="row">
      <strong>{status.functor.replace(/[_-]/g, ' ')}</strong>
      <span class={`chip ${status.state.toLowerCase()}`}>{word(status.state)}</span>
      {held && <span class="chip warn">{held}</span>}
      <span class="grow" />
      {!over && link.mayDrive && <button onClick={() => link.ask({type: 'cancel', id})} aria-label={`Cancel ${status.functor}`}>Cancel</button>}
    </div>
    {goal && <div class="small">{argumentsOf(goal)}</div>}
    {!over && <Bar value={status.progress} label="progress" />}
    <div class="small">{status.reason || status.step}{status.note && ` (${status.note})`}</div>
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
    {state ? <BehaviorTable state={state} />
      : nothing('Nothing is said about behaviors. Is the program "behaviors" there? See Programs.')}
    <OfPrograms link={link} now={now} show={mind => <BehaviorTable state={mind.behaviors} />} />
  </>;
}
function BehaviorTable({state}: {state: Behaviors}) {
  const [open, setOpen] = useState('');
  return <>
    {!state.control && <p class="told bad">The blend is not sent to the robot (behavior control is off).</p>}
    {state.trouble && <p class="told bad">{state.trouble}</p>}
    {state.behaviors.length === 0 && nothing('No behavior is intended: the robot has nothing to do.')}
    {state.behaviors.length > 0 && <table class="behaviors">
      <thead><tr><th scope="col">Behavior</th><th scope="col">Turn</th><th scope="col">Speed</th></tr></thead>
      <tbody>{state.behaviors.map(b => <BehaviorRow key={b.name} b={b} open={open === b.name} toggle={() => setOpen(open === b.name ? '' : b.name)} />)}</tbody>
      <tfoot><tr><th scope="row">Together</th>
        <td><Channel value={state.turning ? -state.turn / 0.6 : 0} weight={0.6} label={`turn ${degrees(state.turn).toFixed(0)} degrees`} /></td>
        <td><Channel value={state.moving ? state.speed / 0.4 : 0} weight={0.6} label={`speed ${state.speed.toFixed(2)} m/s`} /></td></tr></tfoot>
    </table>}
    {state.limit_reason && <p class="small">{state.limit_reason}</p>}
    {state.missing.map(m => <p class="told bad" key={m.name}>{m.name}: {m.reason}</p>)}
  </>;
}
function BehaviorRow({b, open, toggle}: {b: BehaviorState; open: boolean; toggle: () => void}) {
  return <>
    <tr class={b.running ? '' : 'faint'}>
      <th scope="row"><button class="plain" aria-expanded={open} onClick={toggle}>
        <span class="twist" aria-hidden="true">{open ? '▾' : '▸'}</span>{b.name}</button></th>
      <td><Channel value={b.recommends_turn ? -b.turn / 0.6 : 0} weight={b.turn_weight}
                   label={b.recommends_turn ? `turn ${degrees(b.turn).toFixed(0)} degrees, weight ${percent(b.turn_weight)}` : 'no turn'} /></td>
      <td><Channel value={b.recommends_speed ? b.speed / 0.4 : 0} weight={b.speed_weight}
                   label={b.recommends_speed ? `speed ${b.speed.toFixed(2)} m/s, weight ${percent(b.speed_weight)}` : 'no speed'} /></td>
    </tr>
    {open && <tr class="rules"><td colSpan={3}>
      <p class="small">{b.schema}, priority {b.priority}{b.running ? '' : ', not running'}; goal {percent(b.goal)}, progress {percent(b.progress)}</p>
      <ul>{b.rules.map(r => <li key={r.name} class="rule"><span>{r.name}</span><Bar value={r.strength} label={`strength of ${r.name}`} />
        <span class="small">{ruleText(r.action, r.value)}</span></li>)}</ul>
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
    {intentions ? <Tree intentions={intentions} />
      : nothing('Nothing is said about intentions. Is the program "intentions" there? See Programs.')}
    <OfPrograms link={link} now={now} show={mind => <Tree intentions={mind.intended} />} />
  </>;
}
function Tree({intentions}: {intentions: Intentions}) {
  if (intentions.nodes.length === 0) return nothing('The robot intends nothing: it has no goal.');
  const depths = new Map<number, number>();
  return <ul class="intentions">{intentions.nodes.map(node => {
    const depth = Math.min(8, (depths.get(node.parent) ?? -1) + 1);
    depths.set(node.id, depth);
    return <li key={node.id} class={`depth-${depth}`}>
      <div><span class="marker" title={node.blocking ? 'its parent waits for it' : 'its parent goes on'}>{node.blocking ? '∗' : '○'}</span>
        <strong>{node.schema}</strong> {node.name !== node.schema && <span class="faint">{node.name}</span>} <span class="chip">{node.label ? `then ${node.label}` : word(node.state)}</span></div>
      {node.step && <div class="small">{node.step}</div>}
      {node.arguments && <div class="small faint">{node.arguments}</div>}
    </li>;
  })}</ul>;
}

export function WhyTree({link}: {link: Link}) {
  const why = link.data<Why>('why');
  const beliefs = link.data<{beliefs: Belief[]}>('beliefs')?.beliefs ?? [];
  if (!why) return nothing('Nothing is known yet of what the robot does.');
  return <>
    <ul class="why"><Because cause={why.tree} depth={0} /></ul>
    <details class="beliefs"><summary>What it takes to be true ({beliefs.length})</summary>
      <table><tbody>{beliefs.map(b => <tr key={b.name}><th scope="row">{b.name}</th><td>{b.value}</td><td class="faint">{b.said_by}</td></tr>)}</tbody></table>
    </details>
  </>;
}
function Because({cause, depth}: {cause: Cause; depth: number}) {
  const text = <><span class="kind">{cause.kind}</span> {cause.text}</>;
  if (cause.because.length === 0) return <li><span class="leaf">{text}</span></li>;
  return <li><details open={depth < 2}><summary>{text}</summary>
    <ul>{cause.because.map((c, i) => <Because key={c.kind + i} cause={c} depth={depth + 1} />)}</ul></details></li>;
}

export function Programs({link, now}: {link: Link; now: number}) {
  const programs = link.all<ServiceStatus>('system/status').sort((a, b) => a[1].data.name.localeCompare(b[1].data.name));
  const services = link.all<Processes>('processes').sort((a, b) => a[1].data.service.localeCompare(b[1].data.service));
  const act = (service: string, process: string, functor: string) =>
    link.ask({type: 'process', service, process, functor}).then(a => link.note(`${functor} ${process}: ${a.text || (a.well ? 'done' : 'refused')}`, a.well));
  return <>
    <table class="programs"><thead><tr><th scope="col">Program</th><th scope="col">State</th><th scope="col" class="number">Load</th>
      <th scope="col" class="number">Step</th><th scope="col" class="number">Age</th></tr></thead>
      <tbody>{programs.map(([key, {data, at}]) => {
        const age = (now - at) / 1000, lost = age > 3;
        const state = lost ? 'lost' : word(data.state);
        return <><tr key={key} class={lost ? 'bad' : ''}><th scope="row">{data.name}</th>
          <td><span class={`chip ${lost || state === 'degraded' ? 'bad' : state === 'running' ? 'good' : ''}`}>{state}</span></td>
          <td class="number">{data.cpu_percent.toFixed(1)} %</td><td class="number">{data.step_ms_mean > 0 ? `${data.step_ms_mean.toFixed(1)} ms` : ''}</td>
          <td class="number">{age.toFixed(0)} s</td></tr>
          {data.reason && <tr key={key + 'r'}><td colSpan={5} class="small reason">{data.reason}</td></tr>}</>;
      })}</tbody></table>
    {programs.length === 0 && nothing('No program is on the bus.')}
    <h2>Micro-tasks</h2>
    {services.map(([key, {data}]) => <details key={key}><summary>{data.service} ({data.processes.length})</summary>
      <ul class="processes">{data.processes.map(p => {
        const stopped = p.state === 'PROCESS_SUSPENDED' || p.state === 'PROCESS_INTERRUPTED';
        return <li key={p.name} class="row"><span class="grow"><strong>{p.name}</strong> <span class="chip">{word(p.state)}</span><br />
          <span class="small faint">{p.effect}</span></span>
          {link.mayDrive && (stopped
            ? <button aria-label={`Resume ${p.name}`} onClick={() => act(data.service, p.name, 'resume')}>Resume</button>
            : <button aria-label={`Interrupt ${p.name}`} onClick={() => act(data.service, p.name, 'interrupt')}>Interrupt</button>)}</li>;
      })}</ul></details>)}
  </>;
}

export function Messages({link}: {link: Link}) {
  const [all, setAll] = useState(false);
  const [words, setWords] = useState('');
  const say = (event: Event) => {
    event.preventDefault();
    if (words.trim() && link.send({type: 'say', text: words.trim()})) setWords('');
  };
  const messages = link.all<Message>('messages').map(([key, {data, at}]) => ({key, at, from: data.source, text: data.text, level: 'message'}));
  const log = link.all<LogRecord>('system/log').map(([key, {data, at}]) => ({key, at, from: data.name, text: data.text, level: word(data.level)}))
    .filter(l => all || l.level === 'warning' || l.level === 'error');
  const said = link.all<Utterance>('utterances/said').map(([key, {data, at}]) => ({key, at, from: 'robot', text: data.text, level: 'message'}));
  const heard = link.all<Utterance>('utterances/heard').map(([key, {data, at}]) => ({key, at, from: data.speaker || 'somebody', text: data.text, level: 'message'}));
  const lines = [...messages, ...said, ...heard, ...log].sort((a, b) => b.at - a.at || b.key.localeCompare(a.key));
  const understood = link.all<ServiceStatus>('system/status').some(([, {data}]) => data.name === 'dialogue');
  return <>
    <form class="ask" onSubmit={say}>
      <label for="say">Say something to the robot</label>
      <div class="row"><input id="say" value={words} disabled={!link.mayDrive} autocomplete="off"
                              onInput={e => setWords((e.target as HTMLInputElement).value)} />
        <button type="submit" disabled={!link.mayDrive}>Say</button></div>
      {!understood && <p class="small">No program here understands what is said. The deployment "office" has one
        (saphira up office); type goals under Goals.</p>}
    </form>
    <label class="check"><input type="checkbox" checked={all} onChange={e => setAll((e.target as HTMLInputElement).checked)} /> everything that programs log</label>
    {lines.length === 0 && nothing('Nothing has been said, and nothing went wrong.')}
    <ul class="lines" aria-live="polite">{lines.map(l => <li key={l.key} class={l.level}><span class="faint">{l.from}</span> {l.text}</li>)}</ul>
  </>;
}
