// From hands to samples: an on-screen stick, the keys of manual Table 2-1, a gamepad. Each sample says
// whether somebody holds something (the dead-man); 20 a second, also of nothing.
import type {Link} from './link';
import type {ControlState, RobotDescription, RobotState} from './types';

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
  pad = '';                  // the gamepad's name
  padHint = '';

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
    if (!this.mine()) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === 'k' || key === ' ') {
      if (down) this.stop();
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
  // A shoulder button is the dead-man: a stick alone may drift, or lie on its side.
  private fromPad(): boolean {
    const pad = [...(navigator.getGamepads?.() ?? [])].find(p => p?.connected);
    if (!pad) {
      this.pad = this.padHint = '';
      return false;
    }
    this.pad = pad.id.replace(/\s*\(.*/, '').slice(0, 40);
    const held = [4, 5, 6, 7].some(i => pad.buttons[i]?.pressed);
    const dead = (v: number) => Math.abs(v) < deadZone ? 0 : v;
    const [x, y] = [dead(pad.axes[0] ?? 0), dead(-(pad.axes[1] ?? 0))];
    this.padHint = held ? '' : 'hold a shoulder button to drive';
    if (!held) return false;
    this.fromStick(x, y);
    return true;
  }

  private sample() {
    const before = `${this.active} ${this.pad} ${this.padHint}`;
    this.velocity = this.rotation = 0;
    this.active = false;
    if (this.stick) {
      this.fromStick(this.stick.x, this.stick.y);
      this.active = true;
    } else {
      this.active = this.fromKeys() || this.fromPad() || performance.now() < this.stoppedUntil;
    }
    if (this.mine())
      this.link.sendSample({type: 'drive', number: ++this.number, at: performance.now() / 1000, active: this.active,
                      velocity: this.velocity, rotation: this.rotation,
                      cycle: this.link.data<RobotState>('robot/state')?.stamp.cycle ?? 0});
    if (this.mine() || before !== `${this.active} ${this.pad} ${this.padHint}`)
      for (const listener of this.listeners) listener();
  }
}
