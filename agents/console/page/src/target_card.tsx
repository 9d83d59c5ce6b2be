// The card of a place on the map: goals there, and changes of the map.
import type {RefObject} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {ahead, askGoal, nameOf, quoted} from './goals';
import type {Answer, Link} from './link';
import {add, facing, nameFor, placeOf, placeRobot, remove, rules, toUndo, undo, zoneOf, type Sketch} from './map_edit';
import type {Grant, Registration} from './types';
import type {Target, View} from './view';
import {forPage} from './words';

type Form = '' | 'zone' | 'name' | 'facing' | 'goal facing';
const first = 0.5;           // [m] of a new zone, to each side

export function TargetCard({card, corner, link, view, target, close}:
    {card: RefObject<HTMLDivElement>; corner: string; link: Link; view: View; target: Target; close: () => void}) {
  const [told, say] = useState({text: '', well: true});
  const setTold = (text: string, well = true) => say({text, well});
  const [form, show] = useState<Form>('');
  const [, look] = useState(0);
  const open = (next: Form, rule = 'ZONE_KEEP_OUT') => {
    const {x, y} = target, th = link.data<Registration>('registration')?.pose_in_map.th ?? 0;
    view.sketch = next === 'zone' ? {kind: 'zone', rule, from: {x: x - first, y: y - first}, to: {x: x + first, y: y + first}}
      : next === 'facing' || next === 'goal facing' ? {kind: 'facing', rule: '', from: target, to: {x: x + Math.cos(th), y: y + Math.sin(th)}} : undefined;
    view.dirty = true;
    view.onSketch = () => look(n => n + 1);
    show(next);
  };
  useEffect(() => {
    setTold('');
    open('');
  }, [target]);
  // A late answer does not close the card of another place.
  const shown = useRef<Target>();
  shown.current = target;
  useEffect(() => () => { shown.current = undefined; }, []);
  const tell = (answer: Answer, done = close) => {
    if (!answer.well) setTold(forPage(answer.text), false);
    else if (shown.current === target) done();
  };
  const changed = (answer: Answer, text: string) => tell(answer, () => {
    open('');
    setTold(text);
  });
  const onMap = target.frame === 'map';
  return <div ref={card} class={`target ${corner}`} role="dialog" aria-label="A place on the map" onKeyDown={e => e.key === 'Escape' && close()}>
    <div class="row"><strong aria-live="polite">{target.artifact?.name || `${target.x.toFixed(2)}, ${target.y.toFixed(2)} m`}</strong><span class="grow" />
      <button class="plain" aria-label="Close" onClick={close}>×</button></div>
    {link.mayDrive ? <>
      <GoalButtons link={link} target={target} facing={form === 'goal facing' ? facing(view.sketch!) : undefined} tell={tell} setTold={setTold} />
      {target.zones.map(zone => <div class="row" key={zone.id}><span class="grow">{nameFor(zone)}</span>
        <button onClick={async () => changed(await remove(link, zone), 'Removed.')}>Remove</button></div>)}
      <div class="row apart">
        {form === 'facing' && <><span class="grow">Set the robot's position here? Drag towards where it faces.</span>
          <button onClick={async () => tell(await placeRobot(link, {x: target.x, y: target.y, th: facing(view.sketch!)}))}>Yes</button>
          <button onClick={() => open('')}>No</button></>}
        {form === 'goal facing' && <><span class="grow">Drag towards where it is to face there, then press Go.</span>
          <button onClick={() => open('')}>Cancel</button></>}
        {form === 'zone' && <ZoneForm sketch={view.sketch!} draw={sketch => view.drawOn(sketch)} cancel={() => open('')}
          done={async (name, speed) => changed(await add(link, zoneOf(view.sketch!, name, speed)), 'The zone is on the map.')} />}
        {form === 'name' && <NameForm cancel={() => open('')} done={async name => changed(await add(link, placeOf(target, name)), `${name} is a place of the map.`)} />}
        {form === '' && <>
          <button title="a goal with a heading" onClick={() => open('goal facing')}>Facing …</button>
          <button title="a program that takes clicks gets this one" onClick={() => { link.send({type: 'point_out', x: target.x, y: target.y, in_map: onMap}); close(); }}>Tell programs</button>
          {onMap && <>
            <button title="corrects the robot's position on the map" onClick={() => open('facing')}>The robot is here …</button>
            <button title="makes this a place to go to" onClick={() => open('name')}>Name …</button>
            <button title="a part of the floor with a rule: keep out, slowly, one way" onClick={() => open('zone')}>Zone …</button></>}
          {toUndo() && <button onClick={async () => changed(await undo(link), 'Undone.')}>Undo {toUndo()}</button>}
        </>}
      </div>
    </> : <p class="small">Without the key you may watch.</p>}
    {told.text && <p class={told.well ? 'told' : 'told bad'} role="status">{told.text}</p>}
  </div>;
}

function GoalButtons({link, target, facing, tell, setTold}: {link: Link; target: Target; facing?: number; tell: (answer: Answer) => void; setTold: (text: string, well: boolean) => void}) {
  const grant = link.data<Grant>('drive/grant'), before = ahead(link), waiting = before.length - 1;
  const name = target.artifact?.name;
  const go = grant?.waits_for_hand_back ? 'Hand back, go' : 'Go', at = `${target.x.toFixed(3)},${target.y.toFixed(3)}@${target.frame}`;
  const ask = async (place: string, instead: boolean) => {
    const words = facing === undefined ? place : `${place} facing=${facing.toFixed(3)}`;
    if (grant?.estopped) return setTold('The emergency stop is latched: reset it first.', false);
    const answer = await askGoal(link, words, instead ? before : []);
    if (answer.well && grant?.waits_for_hand_back) link.send({type: 'hand_back'});
    tell(answer);
  };
  const buttons = (where: string, words: string, main: boolean, title: string) => <div class="row">{before.length === 0
    ? <button class={main ? 'main' : ''} title={title} onClick={() => ask(words, false)}>{go} {where}</button>
    : <>
      <button class={main ? 'main' : ''} title={`${title}; ends ${before.length === 1 ? 'the goal' : `the ${before.length} goals`} before it`} onClick={() => ask(words, true)}>{go} {where} instead</button>
      <button title={`${title}, once ${before.length === 1 ? 'the goal before it has' : `the ${before.length} goals before it have`} ended`} onClick={() => ask(words, false)}>{go} {where} after that</button>
    </>}</div>;
  return <>
    {before.length > 0 && <p class="small">In front: {nameOf(before[0])}, by {before[0].status.requester}
      {waiting > 0 && `; ${waiting} more ${waiting === 1 ? 'waits' : 'wait'}`}.</p>}
    {name && buttons(`to ${name}`, `go-to-place place=${quoted(name)}`, true, 'by the route that the map gives')}
    {target.routed ? buttons('here', `go-to-place place=${at}`, !name, 'to this point, by the route that the map gives')
      : buttons('here', `go_to position=${at}`, !name, 'straight to this point, around what is in the way, without a route')}
  </>;
}

const ruleWords: {[rule in keyof typeof rules]: string} =
  {ZONE_KEEP_OUT: 'keep out', ZONE_SLOW: 'drive slowly', ZONE_ONE_WAY: 'one way, as drawn', ZONE_PREFERRED: 'preferred by routes'};
function ZoneForm({sketch, draw, done, cancel}: {sketch: Sketch; draw: (sketch: Sketch) => void; done: (name: string, speed: number) => void; cancel: () => void}) {
  const [name, setName] = useState(''), [speed, setSpeed] = useState(0.15);
  const {length, width} = zoneOf(sketch);
  return <form class="grow" onSubmit={e => { e.preventDefault(); done(name.trim(), speed); }}>
    <p class="small">Drag over the map to draw the zone: {length.toFixed(1)} × {width.toFixed(1)} m.</p>
    <div class="row"><select aria-label="Rule of the zone" value={sketch.rule} onChange={e => draw({...sketch, rule: e.currentTarget.value})}>
        {Object.entries(ruleWords).map(([rule, words]) => <option key={rule} value={rule}>{words}</option>)}</select>
      {sketch.rule === 'ZONE_SLOW' && <label class="small"><input type="number" min="0.05" max="1" step="0.05" value={speed} onInput={e => setSpeed(Number(e.currentTarget.value))} /> m/s</label>}</div>
    <div class="row"><input class="grow" aria-label="Name of the zone" placeholder="a name, or none" maxLength={30} value={name} onInput={e => setName(e.currentTarget.value)} />
      <button class="main">Add</button><button type="button" onClick={cancel}>Cancel</button></div>
  </form>;
}
function NameForm({done, cancel}: {done: (name: string) => void; cancel: () => void}) {
  const [name, setName] = useState('');
  return <form class="row grow" onSubmit={e => { e.preventDefault(); if (name.trim()) done(name.trim()); }}>
    <input class="grow" aria-label="Name of the place" placeholder="its name" maxLength={30} value={name} onInput={e => setName(e.currentTarget.value)} />
    <button class="main">Add</button><button type="button" onClick={cancel}>Cancel</button>
  </form>;
}
