// From hands to samples: an on-screen stick, the keys of manual Table 2-1, a gamepad. Each sample says
// whether somebody holds something (the dead-man); 20 a second, also of nothing.
import type {Link} from './link';
import type {ControlState, Grant, RobotDescription, RobotState} from './types';

const period = 50;           // [ms]
const firstStep = 0.05;      // [m/s] of one key
const rate = 0.25;           // [m/s2] of a key that is held
const keyTurn = 0.6;         // [rad/s]
const deadZone = 0.12;       // of a gamepad's stick
const stopHold = 2000;       // [ms] of the key k, as in the terminal
const keysOf: {[key: string]: string} = {
  i: 'faster', ArrowUp: 'faster', m: 'slower', ArrowDown: 'slower', j: 'left', ArrowLeft: 'left',
  l: 'right', ArrowRight: 'right', '.': 'keep',
};

export class Drive {
  maxVelocity = 0.3;         // [m/s] of the stick at its end
  stick?: {x: number; y: number};   // [-1, 1], y ahead; undefined: nobody holds it
  velocity = 0;              // [m/s] of the newest sample
  rotation = 0;              // [rad/s]
  active = false;
  by: '' | 'stick' | 'key' | 'gamepad' = '';   // which is held
  since = 0;                 // [ms] active
  pad = '';                  // the gamepad's name
  padHint = '';
  private padId = '';        // of the gamepad that is held

  stoppedUntil = 0;          // [ms] a stop holds that long against autonomy, too

  private held = new Set<string>();
  private keyVelocity = 0;
  private number = 0;
  private listeners: (() => void)[] = [];

  constructor(private link: Link, private constant: () => void) {
    setInterval(() => this.sample(), period);
    addEventListener('keydown', event => this.key(event, true));
    addEventListener('keyup', event => this.key(event, false));
    // A page that is hidden or without focus does not drive.
    const leave = () => this.release();
    addEventListener('blur', leave);
    addEventListener('pagehide', leave);
    document.addEventListener('visibilitychange', () => document.hidden && leave());
    addEventListener('gamepaddisconnected', () => {
      this.letGo();
      this.pad = this.padHint = '';
    });
  }

  onChange(listener: () => void) { this.listeners.push(listener); }
  mine(): boolean {
    const control = this.link.data<ControlState>('console/control');
    return this.link.id !== 0 && control?.holder === this.link.id;
  }
  // The reason why nothing that is held moves the robot until it was let go, and what to do; empty: there is none.
  letGoFirst(): string {
    if (!this.mine() || !this.by) return '';
    // Of the gateway, or of the bridge.
    const grant = this.link.data<Grant>('drive/grant');
    const why = this.link.data<ControlState>('console/control')!.let_go
      || (grant?.role === 'ROLE_NONE' ? /^(.*): let go/.exec(grant.reason)?.[1] : '');
    if (!why) return '';
    const again = {stick: 'the stick, then hold it', key: 'the key, then press it', gamepad: "the gamepad's shoulder button, then press it", '': ''};
    return `${why[0].toUpperCase()}${why.slice(1)}: let go of ${again[this.by]} again.`;
  }
  // Nothing is held any more; the robot is told at once.
  letGo() {
    this.held.clear();
    this.stick = undefined;
    this.keyVelocity = this.stoppedUntil = 0;
    if (this.mine()) this.sample();
  }
  // The robot stands, whoever drives it: a person has priority over autonomy.
  stop() {
    this.letGo();
    this.stoppedUntil = performance.now() + stopHold;
    this.sample();
  }
  release() {
    if (!this.mine()) return;
    this.letGo();
    this.link.send({type: 'release'});
  }

  private key(event: KeyboardEvent, down: boolean) {
    const target = event.target as HTMLElement;
    if (target.closest('input, select, textarea, summary, [role=tab]') || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === ' ' && target.closest('button')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === 'k' || key === ' ') {
      if (down && this.mine()) this.stop();
      else if (down && !event.repeat) this.stopForAll(key === 'k' ? 'k' : 'space');
    } else if (!this.mine()) {
      return;
    } else if (key === 'g') {
      if (down && !event.repeat) this.constant();
    } else if (key === 'c') {
      if (down && !event.repeat)
        this.link.note('The guard beside the robot always holds; it is not switched from here.', true);
    } else if (keysOf[key]) {
      const what = keysOf[key];
      if (down && !event.repeat) {
        if (what === 'faster') this.keyVelocity = Math.min(this.maxVelocity, this.keyVelocity + firstStep);
        if (what === 'slower') this.keyVelocity = Math.max(-this.maxVelocity, this.keyVelocity - firstStep);
      }
      if (down) this.held.add(what);
      else this.held.delete(what);
      if (this.held.size === 0) this.keyVelocity = 0;
      this.sample();
    } else {
      return;
    }
    event.preventDefault();
  }

  // Without control these keys are the emergency stop, as the button STOP is.
  private stopForAll(key: string) {
    if (!this.link.data<Grant>('drive/grant')?.estopped && this.link.estop())
      this.link.note(`Emergency stop by the key ${key}. It stops the robot for everybody; a stop of 2 s needs control: Drive.`, false);
  }

  private fromKeys(): boolean {
    if (this.held.size === 0) return false;
    const step = rate * period / 1000;
    if (this.held.has('faster')) this.keyVelocity = Math.min(this.maxVelocity, this.keyVelocity + step);
    if (this.held.has('slower')) this.keyVelocity = Math.max(-this.maxVelocity, this.keyVelocity - step);
    this.velocity = this.keyVelocity;
    this.rotation = keyTurn * (Number(this.held.has('left')) - Number(this.held.has('right')));
    return true;
  }
  private fromStick(x: number, y: number) {
    const turn = this.link.data<RobotDescription>('robot/description')?.max_rotation_velocity ?? 1;
    this.velocity = y * this.maxVelocity;
    this.rotation = -x * Math.min(1, turn);
  }
  // A shoulder button is the dead-man: a stick alone may drift, or lie on its side. Of several gamepads
  // the one that is held drives; another one takes over only once nothing is held.
  private fromPad(): boolean {
    const pads = [...(navigator.getGamepads?.() ?? [])].filter(p => p?.connected) as Gamepad[];
    const holds = (p: Gamepad) => [4, 5, 6, 7].some(i => p.buttons[i]?.pressed);
    const some = pads.some(holds);
    if (!some) this.padId = '';
    const id = (p: Gamepad) => `${p.index} ${p.id}`;
    const pad = pads.find(p => holds(p) && (this.padId === '' || this.padId === id(p)));
    const shown = pad ?? pads.find(p => id(p) === this.padId) ?? pads[0];
    this.pad = shown ? shown.id.replace(/\s*\(.*/, '').slice(0, 40) : '';
    this.padHint = pad || !shown ? '' : some ? 'let go of all gamepads first' : 'hold a shoulder button to drive';
    if (!pad) return false;
    this.padId = id(pad);
    const dead = (v: number) => Math.abs(v) < deadZone ? 0 : v;
    this.fromStick(dead(pad.axes[0] ?? 0), dead(-(pad.axes[1] ?? 0)));
    return true;
  }

  private sample() {
    const before = `${this.active} ${this.pad} ${this.padHint}`;
    this.velocity = this.rotation = 0;
    this.by = '';
    if (this.stick) {
      this.fromStick(this.stick.x, this.stick.y);
      this.by = 'stick';
    } else if (this.fromKeys()) {
      this.by = 'key';
    } else if (this.fromPad()) {
      this.by = 'gamepad';
    }
    const now = performance.now(), was = this.active;
    this.active = this.by !== '' || now < this.stoppedUntil;
    if (this.active && !was) this.since = now;
    if (this.mine())
      this.link.sendSample({type: 'drive', number: ++this.number, at: performance.now() / 1000, active: this.active,
                      velocity: this.velocity, rotation: this.rotation,
                      cycle: this.link.data<RobotState>('robot/state')?.stamp.cycle ?? 0});
    if (this.mine() || before !== `${this.active} ${this.pad} ${this.padHint}`)
      for (const listener of this.listeners) listener();
  }
}
