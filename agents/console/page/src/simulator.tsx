// The simulator's own view: what is true, for people; and what they do to it (saphira-sim --view-socket).
import {render} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {socketOf, storedKey} from './address';
import {type Kind, type Robot, type Scene, SimulatorView, type Thing, thingsOf, type World} from './simulator_view';
import {keyless} from './words';

const retry = 1000;           // [ms]
const silent = 3000;          // [ms] without a word the simulator is gone, or stands still
const stepAside = 0.1;        // [m] of an arrow key
const stepAround = 15;        // [degrees]
const zoomStep = 1.3;
const rates = [0.25, 0.5, 1, 2, 5, 10];

// The pins and ports for the user's devices (manual 5.3), by hand instead of by hardware.
interface InputProps { robot: Robot; port: number; setPort: (port: number) => void; disabled: boolean; why?: string; set: (what: object) => void }
function InputRow({robot: {inputs, outputs}, port, setPort, disabled, why, set}: InputProps) {
  const chosen = port < inputs.analog.length ? port : 0;
  return <details><summary class="small">Inputs and outputs</summary>
    <fieldset class="row" disabled={disabled} title={why}><legend class="small">Digital input, pin 0 to 7</legend>
      {[0, 1, 2, 3, 4, 5, 6, 7].map(pin => <input key={pin} type="checkbox" aria-label={`Input pin ${pin}`} checked={(inputs.digital >> pin & 1) === 1}
        onChange={() => set({digital: inputs.digital ^ 1 << pin})} />)}</fieldset>
    <div class="row">
      {inputs.analog.length > 1 && <label class="check">Port <select value={String(chosen)} onChange={e => setPort(Number((e.target as HTMLSelectElement).value))}>
        {inputs.analog.map((_, i) => <option key={i} value={String(i)}>{i}</option>)}</select></label>}
      <label class="check">Analog <input type="range" min="0" max="255" value={inputs.analog[chosen]} disabled={disabled} title={why}
        onInput={e => set({port: chosen, analog: Number((e.target as HTMLInputElement).value)})} /> {(inputs.analog[chosen] * 5 / 255).toFixed(2)} V</label>
    </div>
    <p class="small">Timer {inputs.timer} ms; outputs {outputs.toString(2).padStart(8, '0')} (pin 7 to 0)</p>
  </details>;
}

function App() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useRef<SimulatorView>();
  const socket = useRef<WebSocket>();
  const [world, setWorld] = useState<World>();
  const [scene, setScene] = useState<Scene>();
  const [heard, setHeard] = useState(-1e9);
  const [connected, setConnected] = useState(false);
  const [mayMove, setMayMove] = useState(false);
  const [trouble, setTrouble] = useState('');
  const [chosen, setChosen] = useState('robot 0');
  const [load, setLoad] = useState({world: '', robot: ''});
  const [beams, setBeams] = useState(true);
  const [wake, setWake] = useState(true);
  const [follow, setFollow] = useState(false);
  const [port, setPort] = useState(0);

  const wish = (what: object) => {
    setTrouble('');
    if (socket.current?.readyState === WebSocket.OPEN) socket.current.send(JSON.stringify(what));
    else setTrouble('There is no connection to the console.');
  };
  // A person may have written a file since. The answer is a message of type files.
  const lookForFiles = () => {
    if (mayMove && socket.current?.readyState === WebSocket.OPEN) socket.current.send(JSON.stringify({do: 'files'}));
  };
  const put = (thing: Thing, x: number, y: number, th = thing.th) => {
    if (thing.kind === 'robot') wish({do: 'place', robot: Number(thing.name), x, y, th});
    else if (thing.kind === 'person') wish({do: 'person', name: thing.name, x, y});
    else if (thing.kind === 'box') wish({do: 'box', name: thing.name, x, y, th});
  };
  const turnDoor = (name: string) => {
    const door = view.current?.scene?.doors.find(d => d.name === name);
    if (door) wish({do: 'door', name, open: !door.open});
  };

  useEffect(() => {
    const made = new SimulatorView(canvas.current!);
    view.current = made;
    made.onChoose = setChosen;
    made.onFollow = setFollow;
    made.onDrop = (thing, x, y) => (thing.kind === 'door' ? turnDoor(thing.name) : put(thing, x, y));
    const key = storedKey();
    let ended = false;
    const open = () => {
      if (ended) return;
      const line = socketOf('saphira.simulator');
      socket.current = line;
      line.onopen = () => line.send(JSON.stringify({type: 'hello', key, name: ''}));
      line.onclose = () => {
        setConnected(false);
        setTimeout(open, retry);
      };
      line.onmessage = event => {
        const told = JSON.parse(event.data as string);
        setHeard(performance.now());
        if (told.type === 'hello') {
          setConnected(told.may_watch);
          setMayMove(told.may_drive);
        } else if (told.type === 'world') {
          made.setWorld(told);
          setWorld(told);
          setLoad({world: told.world, robot: ''});
        } else if (told.type === 'files') {
          setWorld(w => w && {...w, worlds: told.worlds, robots: told.robots});
        } else if (told.type === 'scene') {
          made.setScene(told);
          setScene(told);
        } else if (told.type === 'trouble') {
          setTrouble(told.text);
        }
      };
    };
    open();
    const look = setInterval(() => setHeard(h => h + 1e-6), 1000);  // draws the age anew
    return () => {
      ended = true;
      clearInterval(look);
    };
  }, []);
  useEffect(() => {
    if (!view.current) return;
    Object.assign(view.current, {beams, wake, chosen});
    if (view.current.scene) view.current.setScene(view.current.scene);
  }, [beams, wake, chosen]);

  const things = scene ? thingsOf(scene) : [];
  const thing = things.find(t => `${t.kind} ${t.name}` === chosen);
  const robot = thing?.kind === 'robot' ? scene!.robots[Number(thing.name)] : undefined;
  const still = performance.now() - heard > silent;
  const zoomOut = () => view.current?.zoom(1 / zoomStep);
  const shown: Record<string, () => void> = {
    '+': () => view.current?.zoom(zoomStep), '=': () => view.current?.zoom(zoomStep), '-': zoomOut, '_': zoomOut,
    '0': () => view.current?.fit(), c: () => view.current?.recenter(), f: () => view.current?.setFollow(!view.current.follow),
  };
  const keys = (event: KeyboardEvent) => {
    const show = event.ctrlKey || event.altKey || event.metaKey ? undefined : shown[event.key];
    if (show) {
      event.preventDefault();
      return show();
    }
    const way: Record<string, [number, number]> = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    if (!thing || thing.kind === 'door' || !way[event.key]) return;
    event.preventDefault();
    put(thing, thing.x + way[event.key][0] * stepAside, thing.y + way[event.key][1] * stepAside);
  };
  const around = (degrees: number) => thing && put(thing, thing.x, thing.y, thing.th + degrees * Math.PI / 180);
  const label = (t: Thing) => (t.kind === 'robot' ? `robot ${Number(t.name) + 1}` : `${t.kind} ${t.name}`);
  const why = !mayMove ? keyless : !scene ? 'no simulator is heard' : undefined;
  const contacts = scene?.robots.reduce((sum, r) => sum + r.contacts, 0) ?? 0;
  return <>
    <header>
      <h1>Simulator</h1>
      <span class={`chip link ${connected && !still ? 'good' : 'bad'}`}>{!connected ? 'link gone' : !scene ? 'no simulator' : scene.paused ? 'paused' : still ? 'time stands still' : 'runs'}</span>
      <span class="grow small faint"><span class="wide">The robot does not know this truth. Its own view is </span><a href=".">the console</a></span>
    </header>
    <main>
      <section class="picture" aria-label="World">
        <canvas ref={canvas} class="sim-canvas" tabIndex={0} onKeyDown={keys}
                aria-label="The world, from above. Drag robots, people and boxes; press a door; arrow keys move what is chosen. Plus and minus zoom, 0 shows all, c centers the robot, f follows it." />
      </section>
      <section class="side sim-side" aria-label="Time, things and worlds">
        {trouble && <p class="note bad" role="status">{trouble}
          <button class="plain" aria-label="Close this message" onClick={() => setTrouble('')}>×</button></p>}
        {connected && !mayMove && <p class="note">Without the key you may watch: open the address that the console has printed.</p>}
        <h2>Time</h2>
        <div class="row">
          <button class="main" disabled={!mayMove || !scene} title={why} onClick={() => wish({do: 'pause', on: !scene!.paused})}>{scene?.paused ? 'Go on' : 'Pause'}</button>
          <button disabled={!mayMove || !scene?.paused} title={why ?? (scene?.paused ? undefined : 'only while the time is paused')} onClick={() => wish({do: 'step'})}>Step 0.1 s</button>
          <label class="check">Speed <select disabled={!mayMove || !scene} title={why} value={String(scene?.rate ?? 1)}
            onChange={e => wish({do: 'rate', rate: Number((e.target as HTMLSelectElement).value)})}>
            {[...new Set([...rates, scene?.rate ?? 1])].sort((a, b) => a - b).map(r => <option key={r} value={String(r)}>{r} ×</option>)}
          </select></label>
        </div>
        <dl>
          <div><dt>Time</dt><dd>{scene ? `${scene.time.toFixed(2)} s` : ''}</dd></div>
          <div><dt>Contacts</dt><dd>{scene ? contacts : ''}</dd></div>
        </dl>
        <h2>Things</h2>
        <label class="check">Chosen <select value={chosen} onChange={e => setChosen((e.target as HTMLSelectElement).value)}>
          {things.map(t => <option key={t.kind + t.name} value={`${t.kind} ${t.name}`}>{label(t)}</option>)}
        </select></label>
        {thing && thing.kind !== 'door' && <>
          <p class="small">x {thing.x.toFixed(2)} m, y {thing.y.toFixed(2)} m{thing.kind !== 'person' && `, ${(thing.th * 180 / Math.PI).toFixed(0)}°`}. Drag it, or move it in steps of 0.1 m.</p>
          <div class="row" onKeyDown={keys}>
            {(thing.kind as Kind) !== 'person' && <>
              <button disabled={!mayMove} title={why} onClick={() => around(stepAround)}>Turn left</button>
              <button disabled={!mayMove} title={why} onClick={() => around(-stepAround)}>Turn right</button></>}
            {thing.kind === 'robot' && <button disabled={!mayMove} title={why} onClick={() => wish({do: 'disconnect', robot: Number(thing.name)})}>Disconnect</button>}
            <div class="row arrows">{([['←', 'left', -1, 0], ['→', 'right', 1, 0], ['↑', 'up', 0, 1], ['↓', 'down', 0, -1]] as const).map(([sign, name, dx, dy]) =>
              <button key={name} disabled={!mayMove} title={why} aria-label={`Move it ${name}`}
                      onClick={() => put(thing, thing.x + dx * stepAside, thing.y + dy * stepAside)}>{sign}</button>)}</div>
          </div></>}
        {robot?.inputs && <InputRow robot={robot} port={port} setPort={setPort} disabled={!mayMove} why={why}
                            set={what => wish({do: 'input', robot: Number(thing!.name), ...what})} />}
        {thing?.kind === 'door' && <div class="row"><button disabled={!mayMove} title={why} onClick={() => turnDoor(thing.name)}>
          {scene!.doors.find(d => d.name === thing.name)!.open ? 'Close' : 'Open'}</button></div>}
        <h2>Show</h2>
        <div class="row">
          <button title="the robot comes to the middle of the picture (key c)" onClick={() => view.current?.recenter()}>Recenter</button>
          <button aria-pressed={follow} title="the picture moves when the robot comes near its edge (key f)" onClick={() => view.current?.setFollow(!follow)}>Follow</button>
          <button title="the whole world (key 0)" onClick={() => view.current?.fit()}>All</button>
          <button aria-label="Zoom in" title="key +" onClick={() => view.current?.zoom(zoomStep)}>+</button>
          <button aria-label="Zoom out" title="key −" onClick={zoomOut}>−</button>
        </div>
        <div class="row">
          <label class="check"><input type="checkbox" checked={beams} onChange={() => setBeams(!beams)} /> sonar beams</label>
          <label class="check"><input type="checkbox" checked={wake} onChange={() => setWake(!wake)} /> wake</label>
          <button onClick={() => view.current?.clearWake()}>Clear wake</button>
        </div>
        <h2>World and robot</h2>
        <div class="row">
          <label class="check">World <select value={load.world} onFocus={lookForFiles} onPointerEnter={lookForFiles} onChange={e => setLoad({...load, world: (e.target as HTMLSelectElement).value})}>
            {[...new Set([...(world?.worlds ?? []), world?.world ?? ''])].map(w => <option key={w} value={w}>{w}</option>)}</select></label>
          <label class="check">Robot <select value={load.robot} onFocus={lookForFiles} onPointerEnter={lookForFiles} onChange={e => setLoad({...load, robot: (e.target as HTMLSelectElement).value})}>
            <option value="">as it is</option>{world?.robots.map(r => <option key={r} value={r}>{r}</option>)}</select></label>
          <button disabled={!mayMove || !world} title={why} onClick={() => wish({do: 'load', world: load.world === world!.world ? '' : load.world, robot: load.robot})}>Load</button>
        </div>
        <p class="small faint">The robot begins at the world's start. Its own map stays: saphira map load NAME gives it another.</p>
      </section>
    </main>
  </>;
}

const app = document.getElementById('app')!;
app.textContent = '';
render(<App />, app);
