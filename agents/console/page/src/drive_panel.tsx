// The holder of control, and the information that the holder needs.
import {useState} from 'preact/hooks';
import type {Drive} from './drive';
import type {Link} from './link';
import type {ControlState, Grant, RobotDescription, Seen} from './types';
import {forPage} from './words';

const slow = 300;            // [ms] of a round trip, from which on it is said
const patience = 500;        // [ms] until the reason is told why what is held moves nothing
const noteTime = 12_000;     // [ms] of a note on control

export function DrivePanel({link, drive, grant, seen}: {link: Link; drive: Drive; grant?: Grant; seen: Seen}) {
  const control = link.data<ControlState>('console/control');
  if (!link.commanding) return <div class="drive"><p class="small">Driving needs a connection.</p></div>;
  if (!link.mayDrive)
    return <div class="drive"><p class="small">You watch. To drive or to give goals, open the address with the key
      that <code>saphira console</code> prints. The STOP button works for everybody.</p></div>;
  if (drive.mine()) return <Mine link={link} drive={drive} grant={grant} seen={seen} control={control!} />;
  return <Other link={link} control={control} grant={grant} gone={seen.state === 'gone'} />;
}

const goneWords = 'The link to the console is gone: nothing from here reaches the robot, and a robot that was driven from here stands.';

function Other({link, control, grant, gone}: {link: Link; control?: ControlState; grant?: Grant; gone: boolean}) {
  const [name, setName] = useState(link.operator);
  const held = !!control && control.holder !== 0;
  const fresh = performance.now() - (link.get<ControlState>('console/control')?.at ?? -1e9) < noteTime;
  const take = (force: boolean) => {
    (document.activeElement as HTMLElement | null)?.blur();
    link.refused = '';
    void link.takeControl(force);
  };
  return <div class="drive">
    <div class="row">
      {held ? <>
        <span class="grow"><strong>{control.name}</strong> has control.</span>
        <button disabled={gone} onClick={() => link.send({type: 'ask'}) && link.note(`${control.name} is asked for control.`, true)}>Ask for it</button>
        <button disabled={gone} onClick={() => take(true)}>Take it</button>
      </> : <>
        <label for="operator" class="small">I am</label>
        <input id="operator" class="name" value={name} maxLength={20} placeholder="your name" autocomplete="off"
               onInput={e => setName((e.target as HTMLInputElement).value)}
               onChange={() => name.trim() !== link.operator && link.rename(name)} />
        <span class="grow" />
        <button class="main" disabled={gone} onClick={() => take(false)}>Drive</button>
      </>}
      {grant?.waits_for_hand_back && !held && <button disabled={gone} onClick={() => link.send({type: 'hand_back'})}>Hand back</button>}
    </div>
    {gone && <p class="told bad">{goneWords}</p>}
    {control?.note && !held && fresh && <p class="small faint">{control.note}</p>}
  </div>;
}

function Mine({link, drive, grant, seen, control}: {link: Link; drive: Drive; grant?: Grant; seen: Seen; control: ControlState}) {
  const most = link.data<RobotDescription>('robot/description')?.max_velocity ?? 0.4;
  const autonomous = grant?.role === 'ROLE_BEHAVIORS' || grant?.role === 'ROLE_DIRECT';
  const gone = seen.state === 'gone', letGo = drive.letGoFirst();
  const state = gone ? 'the link is gone' : seen.state !== 'live' ? 'no news of the robot'
    : letGo ? 'let go first'
    : drive.active ? `asked ${drive.velocity.toFixed(2)} m/s, ${(drive.rotation * 180 / Math.PI).toFixed(0)} °/s`
    : autonomous ? 'it drives by itself until you hold something' : 'you hold nothing: the robot stands';
  const {doubt, pad, padHint} = drive.hands;
  const key = (code: string) => <kbd>{drive.letters?.get(code) ?? (code === 'Period' ? '.' : code.slice(3).toLowerCase())}</kbd>;
  const speed = (event: Event) => { drive.maxVelocity = Number((event.target as HTMLInputElement).value); };
  return <div class="drive mine">
    <div class="row"><strong>{gone ? 'You drove' : 'You drive'}</strong><span class={letGo || seen.state !== 'live' || !drive.active && autonomous ? 'chip warn' : 'chip'}>{state}</span></div>
    <div class="row">
      <button disabled={gone} title="gives up control; autonomy waits until somebody hands the robot back" onClick={() => drive.release()}>Release</button>
      <button class="main" disabled={gone} title="gives up control; autonomy drives again" onClick={() => { drive.letGo(); link.send({type: 'hand_back'}); }}>Hand back</button></div>
    {control.asked.map(({id, name}) => <div class="row asked" role="alert" key={id}><span class="grow"><strong>{name}</strong> asks for control.</span>
      <button disabled={gone} onClick={() => { drive.letGo(); link.send({type: 'give', to: id}); }}>Give it</button></div>)}
    {gone ? <p class="told bad">{goneWords}</p> : letGo ? <p class="told bad" role="status">{letGo}</p>
      : drive.active && performance.now() - drive.since > patience && grant && grant.role !== 'ROLE_TELEOP'
        && <p class="told bad">{link.refused ? `The newest command ${link.refused}.` : forPage(grant.reason)}</p>}
    {!gone && link.roundTrip > slow && <p class="told bad">Commands take {Math.round(link.roundTrip)} ms there and back: the robot is slowed down.</p>}
    <div class="row"><label for="speed" class="small">Fastest {drive.maxVelocity.toFixed(2)} m/s</label>
      <input id="speed" class="grow" type="range" min="0.05" max={most} step="0.05" value={drive.maxVelocity} onInput={speed} /></div>
    {doubt && <p class="told" role="status">Let go, since {doubt}. Press again to drive.</p>}
    <p class="small faint"><span class="keys">Keys{drive.letters ? '' : ', at their places on a US keyboard'}, held down: {key('KeyI')} faster {key('KeyM')} slower, back {key('KeyJ')} left {key('KeyL')} right {key('Period')} go on; {key('KeyK')} stop
      {' '}{key('KeyG')} constant speed, by the behaviors. </span>{pad ? `Gamepad ${pad}${padHint && ': ' + padHint}.`
        : (drive.hasPads ? 'A gamepad shows once one of its buttons is pressed' : 'This browser gives this page no gamepad')
          + (isSecureContext ? '.' : '; some browsers give one only to a page by https. The command saphira drive takes one without.')}</p>
  </div>;
}
