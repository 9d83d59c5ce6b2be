import {useEffect, useRef, useState} from 'preact/hooks';
import {store, stored} from './address';
import {CameraPanel, cameraOf} from './camera_panel';
import {Drive} from './drive';
import {DrivePanel} from './drive_panel';
import {degrees, heading} from './geometry';
import {Legend} from './legend';
import {Link} from './link';
import {LinkHistory} from './link_panel';
import {BehaviorList, Goals, IntentionTree, Messages, nothing, Programs, WhyTree} from './panels';
import {loadMap, saveMap, type Sketch} from './map_edit';
import {Robots, robotsOf} from './robots_panel';
import {strangersIn} from './strangers';
import {TargetCard} from './target_card';
import type {ConsoleInfo, Devices, Grant, Registration, RobotState, Seen, Why, ServiceStatus} from './types';
import {doubt, type Layers, type Target, View} from './view';
import {driverWords, forPage, keyless, old, percent, seconds} from './words';

const tabs = ['Goals', 'Why', 'Behaviors', 'Intentions', 'Programs', 'Messages'] as const;
type Tab = typeof tabs[number];
type Panel = '' | 'robots' | 'link';   // below the header
const cycle = 100;           // [ms] of the robot
const wordsPeriod = 100;     // [ms] between two looks at the words
const noteTime = 8000;       // [ms]
const longNoteTime = 20_000; // [ms] of bad news
const aside = 30;            // [pixels] of a card from the place that it is about
const cameraShown = 'saphira camera', tabShown = 'saphira tab';
const beside: {[side: string]: number} = {top: 75, bottom: 60};

function look(link: Link, now: number): Seen {
  const robot = link.get<RobotState>('robot/state');
  const age = robot ? now - robot.at : Infinity;
  if (!link.mayWatch) return {state: 'locked', age};
  if (!link.isThere(now)) return {state: 'gone', age};
  if (!robot) return {state: 'silent', age};
  return {state: age > old ? 'old' : 'live', age};
}

export function App() {
  const [link] = useState(() => {
    const made = new Link();
    Object.assign(globalThis, {saphira: made});  // for benchmarks, and for who is curious
    return made;
  });
  const [drive] = useState(() => new Drive(link, () => constant.current()));
  const constant = useRef(() => {});
  const [, redraw] = useState(0);
  const [tab, setTab] = useState<Tab>(tabs.find(each => each === stored(tabShown)) ?? 'Goals');
  const [note, setNote] = useState<{text: string; well: boolean}>();
  const [goal, setGoal] = useState('');
  const [panel, setPanel] = useState<Panel>('');
  const now = performance.now();

  constant.current = async () => {
    if (goal) {
      link.ask({type: 'cancel', id: goal});
      return setGoal('');
    }
    drive.letGo();
    link.send({type: 'hand_back'});
    const answer = await link.ask({type: 'goal', words: 'drive 0.3'});
    if (answer.well) setGoal(answer.id);
    setNote(answer.well ? {text: 'Constant velocity: the behaviors drive, avoiding what is in the way. Press g again to end it.', well: true} : answer);
  };

  useEffect(() => {
    let due = false;
    const words = () => {
      if (due) return;
      due = true;
      setTimeout(() => {
        due = false;
        redraw(n => n + 1);
      }, wordsPeriod);
    };
    link.onFrame(words);
    drive.onChange(words);
    let timer = 0;
    link.onNote((text, well) => {
      clearTimeout(timer);
      setNote({text, well});
      timer = window.setTimeout(() => setNote(undefined), well ? noteTime : longNoteTime);
    });
  }, []);

  const state = look(link, now);
  const grant = link.data<Grant>('drive/grant');
  return <>
    <Header link={link} drive={drive} seen={state} panel={panel} open={which => setPanel(which === panel ? '' : which)} />
    {panel === 'robots' && <Robots link={link} gone={state.state === 'gone'} close={() => setPanel('')} />}
    {panel === 'link' && <LinkHistory link={link} seen={state} close={() => setPanel('')} />}
    <main>
      <section class="picture" aria-label="Map">
        <Picture link={link} drive={drive} seen={state} />
      </section>
      <section class="side" aria-label="Goals, reasons and programs">
        {grant?.estopped && <Estopped link={link} grant={grant} />}
        <Now link={link} drive={drive} grant={grant} seen={state} />
        <DrivePanel link={link} drive={drive} grant={grant} seen={state} />
        {note && <p class={note.well ? 'note' : 'note bad'} role="status">{forPage(note.text)}
          <button class="plain" aria-label="Close this message" onClick={() => setNote(undefined)}>×</button></p>}
        <Tabs tab={tab} choose={which => { store(tabShown, which); setTab(which); }} />
        <div class="panel" role="tabpanel" id="panel" aria-labelledby={`tab-${tab}`} tabIndex={0}>
          {tab === 'Goals' && <Goals link={link} now={now} />}
          {tab === 'Why' && <WhyTree link={link} />}
          {tab === 'Behaviors' && <BehaviorList link={link} now={now} />}
          {tab === 'Intentions' && <IntentionTree link={link} now={now} />}
          {tab === 'Programs' && <Programs link={link} now={now} />}
          {tab === 'Messages' && <Messages link={link} />}
        </div>
      </section>
    </main>
  </>;
}

const linkWords = {live: 'live', old: 'old', silent: 'no robot', gone: 'link gone', locked: 'locked'};

function Header({link, drive, seen: s, panel, open}: {link: Link; drive: Drive; seen: Seen; panel: Panel; open: (panel: Panel) => void}) {
  const info = link.data<ConsoleInfo>('console');
  // A replay also plays the recorder's own status.
  const runs = (name: string) => link.all<ServiceStatus>('system/status').some(([, {data, at}]) => data.name === name && performance.now() - at < 3000);
  const count = robotsOf(link).length;
  const strangers = strangersIn(link.all<ServiceStatus>('system/status').map(([, {data}]) => data));
  const estop = () => {
    link.estop();
    drive.letGo('STOP was pressed');
  };
  return <header>
    <h1>{info?.robot ?? 'Saphira'}</h1>
    {(count > 1 || panel === 'robots') && <button aria-expanded={panel === 'robots'} title="the other robots on this bus" onClick={() => open('robots')}>{count} robots</button>}
    {runs('replay') ? <span class="chip warn" title="saphira replay plays it: nothing here moves">a recording</span>
      : runs('record') && <span class="chip" title="saphira record keeps what is said on the bus">is recorded</span>}
    <button class={`chip link ${s.state}`} aria-expanded={panel === 'link'} title="age of the picture; round trip of a command; open: the last minutes" onClick={() => open('link')}>
      {linkWords[s.state]}{Number.isFinite(s.age) && s.state !== 'gone' && ` ${s.age < 1000 ? `${Math.max(0, Math.round(s.age / 10) * 10)} ms` : `${(s.age / 1000).toFixed(1)} s`}`}
      {link.roundTrip > 0 && s.state !== 'gone' && <span class="wide">, there and back {Math.round(link.roundTrip)} ms</span>}
    </button>
    <span class="grow" />
    {strangers.length > 0 && <span class="chip bad" title="see Programs">{strangers.length === 1 ? 'a stranger is' : `${strangers.length} strangers are`} kept out</span>}
    {info?.simulator && <a class="wide" href="simulator.html">the simulator's own view</a>}
    {/* At the touch, also of a second finger, which makes no click; the click is the keyboard's. */}
    <button class="estop" onPointerDown={estop} onClick={e => e.detail === 0 && estop()}
            aria-label="Emergency stop">{link.stopping ? 'STOP …' : 'STOP'}</button>
  </header>;
}

function Estopped({link, grant}: {link: Link; grant: Grant}) {
  return <div class="alarm" role="alert">
    <div><strong>Emergency stop</strong> pressed by {grant.estop_source}. The robot stands until Reset; its goals are ended.</div>
    <button disabled={!link.mayDrive} title={link.mayDrive ? 'lets the robot take goals again' : keyless} onClick={() => link.send({type: 'estop_reset'})}>Reset</button>
  </div>;
}

// The information area (manual 2.3.3), and above it in one sentence what goes on.
function sentence(drive: Drive, robot: RobotState, grant?: Grant, why?: Why): string {
  if (grant?.estopped) return `Emergency stop: the robot stands until Reset, and then until ${grant.waits_for_hand_back ? 'Hand back: a person drove' : 'it gets a new goal'}.`;
  if (grant?.waits_for_hand_back) return drive.letGoFirst() || (drive.mine() ? 'You have control: hold something to drive, or hand the robot back.' : 'A person drove last: autonomy waits for Hand back.');
  // Of the cycle that it tells of: a program that hangs leaves an old one.
  const age = why && why.epoch === robot.stamp.epoch ? cycle * (robot.stamp.cycle - why.cycle) : 0;
  return (age >= old ? `${seconds(age)} ago: ` : '') + forPage(why?.sentence ?? grant?.reason ?? '');
}
function Now({link, drive, grant, seen: s}: {link: Link; drive: Drive; grant?: Grant; seen: Seen}) {
  const robot = link.data<RobotState>('robot/state');
  const registration = link.data<Registration>('registration');
  const why = link.data<Why>('why'), devices = link.data<Devices>('robot/devices');
  const [whole, setWhole] = useState(false);
  if (!robot) return <div class="now">{nothing(s.state === 'live' || s.state === 'silent' ? 'The console runs, and no robot is heard. Its bridge may be missing, or its power off.' : 'Nothing is known of the robot yet.')}</div>;
  const tracking = registration?.state === 'REGISTRATION_TRACKING';
  const lost = registration?.state === 'REGISTRATION_LOST';
  const trouble = link.all<ServiceStatus>('system/status').find(([, {data}]) => data.name === 'bridge' && data.state === 'SERVICE_DEGRADED')?.[1].data.reason;
  const pose = tracking || lost ? registration!.pose_in_map : robot.pose_in_odom;
  const doubtful = registration && (lost || tracking && registration.confidence <= doubt);
  const sure = tracking || lost ? `, ${percent(registration!.confidence)} sure` : '';
  const sigma = tracking ? Math.sqrt(Math.max(0, (registration!.covariance.xx + registration!.covariance.yy) / 2)) : 0;
  return <div class={`now ${s.state}`}>
    <p class={whole ? 'sentence whole' : 'sentence'} title={why?.sentence} onClick={() => setWhole(!whole)}>{s.state === 'gone' && 'Last heard: '}{sentence(drive, robot, grant, why)}</p>
    {grant && grant.guard !== 'GUARD_NONE' && <p class="guard">Guard: {forPage(grant.guard_reason)}</p>}
    <dl>
      <div><dt>Status</dt><dd>{robot.status.replace('MOTORS_', '').replace('_', ' ').toLowerCase()}{(robot.left_stalled || robot.right_stalled) && ', stalled'}</dd></div>
      <div><dt>Driver</dt><dd>{driverWords[grant?.role ?? ''] ?? '?'}</dd></div>
      <div><dt>Speed</dt><dd>{robot.velocity.toFixed(2)} m/s</dd></div>
      <div><dt>Turning</dt><dd>{degrees(robot.rotation_velocity).toFixed(0)} °/s</dd></div>
      <div class="place"><dt>{tracking ? 'On the map' : lost ? 'Lost, at a guess' : 'By odometry'}</dt><dd>{pose.x.toFixed(2)}, {pose.y.toFixed(2)} m, {heading(pose.th)}°
        {tracking ? ` ± ${sigma < 0.1 ? (100 * sigma).toFixed(0) + ' cm' : sigma.toFixed(1) + ' m'}` : lost ? '' : ` (${(registration?.state ?? 'no registration').replace('REGISTRATION_', '').toLowerCase()})`}{sure}</dd></div>
      <div><dt>Battery</dt><dd>{robot.battery.toFixed(1)} V{devices?.has_charge && `, ${percent(devices.charge)}`}{!!devices?.charging && ', charging'}</dd></div>
      <div class="place"><dt>Packets a second</dt><dd>motors {robot.motor_packets_per_s}, sonars {robot.sonar_readings_per_s}, vision {robot.vision_packets_per_s}</dd></div>
    </dl>
    {trouble && !grant?.estopped && <p class="guard">{forPage(trouble)}</p>}
    {doubtful && <p class="guard">{lost ? 'The robot does not know where it is' : 'The place is not confirmed'} ({forPage(registration.reason)}).
      {lost && ' Click where it is on the map: The robot is here …'}</p>}
  </div>;
}

function Tabs({tab, choose}: {tab: Tab; choose: (tab: Tab) => void}) {
  const key = (event: KeyboardEvent) => {
    const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (!step) return;
    const next = tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length];
    choose(next);
    document.getElementById(`tab-${next}`)?.focus();
    event.preventDefault();
  };
  return <div class="tabs" role="tablist" aria-label="Views" onKeyDown={key}>
    {tabs.map(t => <button key={t} role="tab" id={`tab-${t}`} aria-selected={t === tab} aria-controls="panel"
                           tabIndex={t === tab ? 0 : -1} onClick={() => choose(t)}>{t}</button>)}
  </div>;
}

function Picture({link, drive, seen: s}: {link: Link; drive: Drive; seen: Seen}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const card = useRef<HTMLDivElement>(null);
  const closer = useRef(() => {});
  const view = useRef<View>();
  const [target, setTarget] = useState<Target>();
  const [corner, setCorner] = useState('');
  const [layers, setLayers] = useState<Layers>();
  const [camera, setCamera] = useState(!!stored(cameraShown));
  const [, look] = useState(0);
  const driving = drive.mine();
  useEffect(() => {
    const v = view.current = new View(canvas.current!, link);
    setLayers({...v.layers});
    link.onFrame(() => v.news());
    let fitted = false;
    // Between two samples the picture moves on, where people do not mind.
    const calm = matchMedia('(prefers-reduced-motion: reduce)');
    const draw = () => {
      const robot = link.get<RobotState>('robot/state');
      // The whole map at first; the robot with what is around it where there is no map.
      if (!fitted && robot && link.data('map') && link.data('registration')) {
        fitted = true;
        if (v.onMap()) v.fit();
      }
      const moving = robot && performance.now() - robot.at < 300 && (robot.data.velocity !== 0 || robot.data.rotation_velocity !== 0);
      if (v.dirty || moving && !calm.matches) {
        v.draw();
        if (v.target && card.current) setCorner(was => cornerFor(v, card.current!, was));
      }
      requestAnimationFrame(draw);
    };
    draw();
    listen(canvas.current!, v, {
      choose: at => {
        v.target = at;
        v.dirty = true;
        setTarget(at);
        setCorner(cornerFor(v, card.current));
      },
      enter: () => card.current?.querySelector<HTMLElement>('.main')?.focus(),
      close: () => closer.current(),
      driving: () => drive.mine(),
    });
  }, []);
  // The stick lies over the picture: all of the map goes beside it.
  useEffect(() => {
    const stick = document.querySelector('.stick'), v = view.current;
    if (!v) return;
    const over = stick && getComputedStyle(stick).position === 'absolute' && stick.getBoundingClientRect(), picture = canvas.current!.getBoundingClientRect();
    v.bottom = over ? picture.bottom - over.top : 0;
    v.left = over ? over.right - picture.left : 0;
    if (v.whole) v.fit();
  }, [driving]);
  const v = view.current;
  const close = closer.current = () => {
    if (v) v.target = v.sketch = undefined, v.dirty = true;
    if (card.current?.contains(document.activeElement)) canvas.current!.focus({preventScroll: true});
    setTarget(undefined);
  };
  const toggle = (layer: keyof Layers) => {
    v!.layers[layer] = !v!.layers[layer];
    v!.dirty = true;
    setLayers({...v!.layers});
  };
  const act = (change: () => void) => {
    if (v) change(), v.dirty = true;
    look(n => n + 1);
  };
  const showCamera = (on: boolean) => {
    store(cameraShown, on ? 'yes' : '');
    setCamera(on);
  };
  const hasCamera = !!cameraOf(link);
  const stale = s.state !== 'live';
  return <>
    <div class="map">
      <canvas ref={canvas} class={stale ? 'stale' : ''} role="application" tabIndex={0}
              aria-label={`${v?.local ? 'Around the robot' : 'Map'} with the robot, its sonar echoes and percepts. Arrow keys choose a place, Enter goes to its buttons, Escape leaves it.`} />
      {stale && <p class="banner" role="status">{bannerText(s, link.barrier)}</p>}
      <div class="tools" role="group" aria-label="View">
        <button aria-pressed={!!v?.local} title="the robot in the middle, pointing up" onClick={() => act(() => { v!.local = !v!.local; v!.whole = false; })}>Local</button>
        <button aria-pressed={!!v?.follow && !v.local} title="the map moves with the robot" onClick={() => act(() => { v!.local = v!.whole = false; v!.follow = !v!.follow; })}>Follow</button>
        <button title="the whole map" onClick={() => act(() => v!.fit())}>All</button>
        <button aria-label="Grow" onClick={() => act(() => v!.zoom(1.3))}>+</button>
        <button aria-label="Shrink" onClick={() => act(() => v!.zoom(1 / 1.3))}>−</button>
        {hasCamera && <button aria-pressed={camera} title="what the robot's camera sees" onClick={() => showCamera(!camera)}>
          <span class="word">Camera</span><span class="sign" aria-hidden="true">◉</span></button>}
        <Legend />
      </div>
      {layers && <details class="layers" onToggle={() => act(() => {})}><summary>Layers<span class="wide">, map</span></summary>
        {(Object.keys(layers) as (keyof Layers)[]).map(name => <label key={name} class="check">
          <input type="checkbox" checked={layers[name]} onChange={() => toggle(name)} /> {layerWords[name]}</label>)}
        <button onClick={() => act(() => v!.clearEchoes())}>Clear echoes</button>
        <p class="row"><button onClick={() => saveMap(link)}>Save the map</button>
          {link.mayOperate && <label class="button">Load a map …<input type="file" accept=".map,.txt,text/plain" onChange={e => {
            const input = e.target as HTMLInputElement, file = input.files?.[0];
            if (file) void loadMap(link, file);
            input.value = '';   // the same file, mended, again
          }} /></label>}</p>
        {/* In the header where that has room. */}
        {link.data<ConsoleInfo>('console')?.simulator && <p class="narrow"><a href="simulator.html">the simulator's own view</a></p>}
      </details>}
    </div>
    {camera && hasCamera && <CameraPanel link={link} close={() => showCamera(false)} />}
    {driving && s.state !== 'gone' && <Stick drive={drive} />}
    {target && v && <TargetCard card={card} corner={corner} link={link} view={v} target={target} close={close} />}
  </>;
}
// The corner of the picture for the card, so that it covers nothing of the target: as it is, else the farthest.
function cornerFor(view: View, card: HTMLElement | null, was = ''): string {
  const picture = view.inWindow(), points = view.targetInWindow();
  const x = (side: string) => side === 'left' ? picture.left : picture.right, y = (side: string) => side === 'top' ? picture.top : picture.bottom;
  const {width = 0, height = 0} = card?.getBoundingClientRect() ?? {};
  const free = (corner: string) => {
    const [v, h] = corner.split(' ');
    return points.every(p => Math.abs(p.x - x(h)) > width + aside || Math.abs(p.y - y(v)) > height + beside[v]);
  };
  const corners = [...(document.querySelector('.camera') ? [] : ['bottom right']), ...(document.querySelector('.layers[open]') ? [] : ['top right']),
    ...(document.querySelector('#legend:not([hidden])') ? [] : ['top left']),
    ...(view.bottom > 0 ? [] : ['bottom left'])];   // the stick
  if (corners.includes(was) && free(was)) return was;
  const far = (corner: string) => Math.hypot(points[0].x - x(corner.split(' ')[1]), points[0].y - y(corner.split(' ')[0]));
  corners.sort((a, b) => far(b) - far(a));
  return corners.find(free) ?? corners[0];
}
const layerWords: {[name in keyof Layers]: string} =
  {grid: 'occupancy grid', sonar: 'sonar echoes', map: 'the map', route: 'the route', drawings: 'drawings of programs', percepts: 'percepts', areas: 'sensitive areas of behaviors', wake: 'wake (10 s)'};
function bannerText(s: Seen, barrier: string): string {
  const age = Number.isFinite(s.age) ? `The picture is ${seconds(s.age)} old. ` : '';
  switch (s.state) {
    case 'locked': return 'The key is needed to watch from here: open the address that the console has printed, or put its # and what follows behind the address of this page.';
    case 'gone': return barrier || `${age}There is no connection to the console, so STOP does not work from here: use the robot's own switch. Trying again …`;
    case 'silent': return 'No robot is heard.';
    default: return `${age}The robot says nothing.`;
  }
}

// A click chooses a place; a drag moves the map, or draws on it where something is to be drawn; a wheel or two fingers change its scale. Arrow keys
// choose a place too, from the middle on: by 8 pixels, with Shift by 40.
const ways: {[key: string]: [number, number]} = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1], Enter: [0, 0]};
interface Choice { choose: (target: Target) => void; enter: () => void; close: () => void; driving: () => boolean }
function listen(canvas: HTMLCanvasElement, view: View, {choose, enter, close, driving}: Choice) {
  canvas.addEventListener('keydown', e => {
    if (e.key === 'Escape') close();
    if (!ways[e.key] || driving()) return;   // the keys drive
    e.preventDefault();
    const {left, top, width, height} = view.inWindow(), at = view.targetInWindow()[0];
    if (at && e.key === 'Enter') return enter();
    const step = at ? e.shiftKey ? 40 : 8 : 0, [x, y] = at ? [at.x - left, at.y - top] : [width / 2, height / 2];
    const inside = (value: number, size: number) => Math.max(0, Math.min(size - 1, value));
    choose(view.at(inside(x + step * ways[e.key][0], width), inside(y + step * ways[e.key][1], height)));
  });
  const pointers = new Map<number, {x: number; y: number}>();
  let moved = 0, apart = 0, first: Target;
  canvas.addEventListener('pointerdown', e => {
    pointers.set(e.pointerId, {x: e.offsetX, y: e.offsetY});
    if (pointers.size === 1) moved = 0, first = view.at(e.offsetX, e.offsetY);
    canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener('pointermove', e => {
    const last = pointers.get(e.pointerId);
    if (!last) return;
    const at = {x: e.offsetX, y: e.offsetY};
    moved += Math.hypot(at.x - last.x, at.y - last.y);
    pointers.set(e.pointerId, at);
    if (pointers.size === 1) {
      if (moved > 5 && view.sketch) draw(view.sketch, view.at(at.x, at.y));
      else if (moved > 5) view.drag(at.x - last.x, at.y - last.y);
    } else {
      const [a, b] = [...pointers.values()];
      const now = Math.hypot(a.x - b.x, a.y - b.y);
      if (apart > 0) view.zoom(now / apart);
      apart = now;
    }
  });
  const draw = (sketch: Sketch, to: Target) => view.drawOn({...sketch, from: sketch.kind === 'zone' ? first : sketch.from, to});
  const end = (e: PointerEvent) => {
    if (pointers.size === 1 && moved <= 5 && e.type === 'pointerup') {
      const at = view.at(e.offsetX, e.offsetY);
      if (view.sketch?.kind === 'facing') draw(view.sketch, at);
      else choose(at);
    }
    pointers.delete(e.pointerId);
    apart = 0;
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('wheel', e => {
    view.zoom(Math.exp(-e.deltaY / 500));
    e.preventDefault();
  }, {passive: false});
}

function Stick({drive: {active, by, hands}}: {drive: Drive}) {
  const pad = useRef<SVGSVGElement>(null);
  const place = (event: PointerEvent) => {
    const box = pad.current!.getBoundingClientRect();
    const x = (2 * (event.clientX - box.left) / box.width - 1) / 0.75, y = (1 - 2 * (event.clientY - box.top) / box.height) / 0.75;
    const r = Math.max(1, Math.hypot(x, y));
    return {x: x / r, y: y / r};
  };
  const at = by === 'stick' ? hands.at : {x: 0, y: 0};
  return <svg ref={pad} class={active ? 'stick held' : 'stick'} viewBox="-100 -100 200 200" role="img"
              aria-label="Stick: hold and move it to drive; or use the keys"
              onPointerDown={e => {
                e.preventDefault();
                if (e.button !== 0) return;
                pad.current!.setPointerCapture(e.pointerId);
                hands.grasp(e.pointerId, place(e), () => !!pad.current?.isConnected);
              }}
              onPointerMove={e => hands.move(e.pointerId, place(e), e.buttons !== 0)}
              onContextMenu={e => e.preventDefault()}>
    <circle class="stick-ground" r="98" />
    <path class="stick-arrow" d="M0-90 8-78H-8ZM0 90 8 78H-8ZM-90 0-78 8V-8ZM90 0 78 8V-8Z" />
    <circle class="stick-knob" cx={75 * at.x} cy={-75 * at.y} r="26" />
  </svg>;
}
