// The holder of control, and the information that the holder needs.
import {useState} from 'preact/hooks';
import type {Drive} from './drive';
import type {Link} from './link';
import type {ControlState, Grant, RobotDescription} from './types';
import {forPage} from './words';

const slow = 300;            // [ms] of a round trip, from which on it is said
const noteTime = 12_000;     // [ms] of a note on control

export function DrivePanel({link, drive, grant}: {link: Link; drive: Drive; grant?: Grant}) {
  const control = link.data<ControlState>('console/control');
  if (!link.commanding) return <div class="drive"><p class="small">Driving needs a connection.</p></div>;
  if (!link.mayDrive)
    return <div class="drive"><p class="small">You watch. To drive or to give goals, open the address with the key
      that <code>saphira console</code> prints. The STOP button works for everybody.</p></div>;
  if (drive.mine()) return <Mine link={link} drive={drive} grant={grant} control={control!} />;
  return <Other link={link} control={control} grant={grant} />;
}

function Other({link, control, grant}: {link: Link; control?: ControlState; grant?: Grant}) {
  const [name, setName] = useState(link.operator);
  const held = !!control && control.holder !== 0;
  const fresh = performance.now() - (link.get<ControlState>('console/control')?.at ?? -1e9) < noteTime;
  const take = (force: boolean) => {
    (document.activeElement as HTMLElement | null)?.blur();
    link.refused = '';
    link.send({type: 'take', force});
  };
  return <div class="drive">
    <div class="row">
      {held ? <>
        <span class="grow"><strong>{control.name}</strong> has control.</span>
        <button onClick={() => link.send({type: 'ask'}) && link.note(`${control.name} is asked for control.`, true)}>Ask for it</button>
        <button onClick={() => take(true)}>Take it</button>
      </> : <>
        <label for="operator" class="small">I am</label>
        <input id="operator" class="name" value={name} maxLength={20} placeholder="your name" autocomplete="off"
               onInput={e => setName((e.target as HTMLInputElement).value)}
               onChange={() => name.trim() !== link.operator && link.rename(name)} />
        <span class="grow" />
        <button class="main" onClick={() => take(false)}>Drive</button>
      </>}
      {grant?.waits_for_hand_back && !held && <button onClick={() => link.send({type: 'hand_back'})}>Hand back</button>}
    </div>
    {control?.note && !held && fresh && <p class="small faint">{control.note}</p>}
  </div>;
}

function Mine({link, drive, grant, control}: {link: Link; drive: Drive; grant?: Grant; control: ControlState}) {
  const most = link.data<RobotDescription>('robot/description')?.max_velocity ?? 0.4;
  const autonomous = grant?.role === 'ROLE_BEHAVIORS' || grant?.role === 'ROLE_DIRECT';
  const state = control.let_go && drive.active ? 'let go first'
    : drive.active ? `asked ${drive.velocity.toFixed(2)} m/s, ${(drive.rotation * 180 / Math.PI).toFixed(0)} °/s`
    : autonomous ? 'it drives by itself until you hold something' : 'you hold nothing: the robot stands';
  const speed = (event: Event) => { drive.maxVelocity = Number((event.target as HTMLInputElement).value); };
  return <div class="drive mine">
    <div class="row"><strong>You drive</strong><span class={!drive.active && autonomous ? 'chip warn' : 'chip'}>{state}</span></div>
    <div class="row">
      <button title="gives up control; autonomy waits until somebody hands the robot back" onClick={() => drive.release()}>Release</button>
      <button class="main" title="gives up control; autonomy drives again" onClick={() => { drive.letGo(); link.send({type: 'hand_back'}); }}>Hand back</button></div>
    {control.asked.map(name => <div class="row asked" role="alert" key={name}><span class="grow"><strong>{name}</strong> asks for control.</span>
      <button onClick={() => drive.release()}>Give it</button></div>)}
    {drive.active && grant && grant.role !== 'ROLE_TELEOP' && <p class="told bad">{forPage(grant.reason)}</p>}
    {drive.active && link.refused && <p class="told bad">{link.refused}</p>}
    {link.roundTrip > slow && <p class="told bad">Commands take {Math.round(link.roundTrip)} ms there and back: the robot is slowed down.</p>}
    <div class="row"><label for="speed" class="small">Fastest {drive.maxVelocity.toFixed(2)} m/s</label>
      <input id="speed" class="grow" type="range" min="0.05" max={most} step="0.05" value={drive.maxVelocity} onInput={speed} /></div>
    <p class="small faint">Keys, held down: <kbd>i</kbd> faster <kbd>m</kbd> slower, back <kbd>j</kbd> left <kbd>l</kbd> right <kbd>.</kbd> go on; <kbd>k</kbd> stop
      {' '}<kbd>g</kbd> constant speed, by the behaviors. {drive.pad ? `Gamepad ${drive.pad}${drive.padHint && ': ' + drive.padHint}.` : 'A gamepad shows once one of its buttons is pressed.'}</p>
  </div>;
}
