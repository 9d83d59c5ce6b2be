// From hands to samples: what is held (hands.ts), with the speeds of manual Table 2-1. Each sample says whether
// somebody holds something (the dead-man); 20 a second, also of nothing.
import {type Act, Hands, period} from './hands';
import type {Link} from './link';
import type {ControlState, Grant, RobotDescription, RobotState} from './types';

const firstStep = 0.05;      // [m/s] of one key
const rate = 0.25;           // [m/s2] of a key that is held
const keyTurn = 0.6;         // [rad/s]
const fields = 'input:not([type=range], [type=checkbox]), select, textarea, [contenteditable]';

// The element with the focus uses this key itself.
function own(event: KeyboardEvent): boolean {
  const within = (names: string) => !!(event.target as Element).closest?.(names);
  return event.isComposing || within(fields)
    || event.code === 'Space' && within('button, summary, input, a') || /^(Arrow|Numpad)/.test(event.code) && within('input, [role=tab]');
}
// Undefined: this browser has none for this page.
function gamepads(): Gamepad[] | undefined {
  try {
    return navigator.getGamepads().filter(p => p?.connected) as Gamepad[];
  } catch {
    return undefined;
  }
}

export class Drive {
  maxVelocity = 0.3;         // [m/s] of the stick at its end
  velocity = 0;              // [m/s] of the newest sample
  rotation = 0;              // [rad/s]
  active = false;
  by: '' | 'stick' | 'key' | 'gamepad' = '';   // which is held
  since = 0;                 // [ms] active
  hands = new Hands();
  hasPads = true;            // the browser has gamepads for this page
  letters?: {get(code: string): string | undefined};   // of the person's keyboard, where the browser tells

  private keyVelocity = 0;
  private sampled = 0;       // [ms]
  private number = 0;
  private listeners: (() => void)[] = [];

  constructor(private link: Link, private constant: () => void) {
    setInterval(() => this.sample(), period);
    addEventListener('keydown', event => this.key(event));
    addEventListener('keyup', event => {
      this.hands.release(event.code, performance.now());
      if (this.mine()) this.sample();
    });
    // Heard by the window: the stick may be gone from the page, with its capture.
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const)
      addEventListener(end, event => {
        this.hands.drop(event.pointerId);
        if (this.mine()) this.sample();
      });
    // A page that is hidden or without focus does not drive.
    const leave = () => this.release();
    addEventListener('blur', leave);
    addEventListener('pagehide', leave);
    document.addEventListener('visibilitychange', () => document.hidden && leave());
    // Each of these may take releases for itself.
    addEventListener('focusin', event => (event.target as Element).matches(fields) && this.letGo('a field has the focus'));
    addEventListener('contextmenu', event => event.defaultPrevented || this.letGo('a menu is open'));
    addEventListener('dragstart', () => this.letGo('something is dragged'));
    addEventListener('gamepaddisconnected', () => this.letGo('a gamepad is gone'));
    // The keys of a page that drives are for driving: a control that was clicked does not keep them.
    addEventListener('click', event => {
      const focused = document.activeElement as HTMLElement | null;
      if (event.detail > 0 && this.mine() && focused?.matches('button, summary, input') && !focused.matches(fields)) focused.blur();
    });
    const learn = () => (navigator as Navigator & {keyboard?: {getLayoutMap?(): Promise<Map<string, string>>}})
      .keyboard?.getLayoutMap?.().then(letters => { this.letters = letters; }, () => {});
    addEventListener('focus', learn);
    learn();
  }

  onChange(listener: () => void) { this.listeners.push(listener); }
  mine(): boolean { return this.link.mine(); }
  // The reason why nothing that is held moves the robot until it was let go, and what to do; empty: there is none.
  letGoFirst(): string {
    if (!this.mine() || !this.by) return '';
    // Of the gateway, or of the bridge.
    const grant = this.link.data<Grant>('drive/grant');
    const why = this.link.data<ControlState>('console/control')!.let_go
      || (grant?.role === 'ROLE_NONE' ? /^(.*): let go/.exec(grant.reason)?.[1] : '');
    if (!why) return '';
    const again = {stick: 'the stick, then hold it', key: 'the key, then press it', gamepad: "the gamepad's button, then press it", '': ''};
    return `${why[0].toUpperCase()}${why.slice(1)}: let go of ${again[this.by]} again.`;
  }
  // Nothing is held any more; the robot is told at once.
  letGo(why = '') {
    this.hands.letGo(why);
    if (this.mine()) this.sample();
  }
  release() {
    if (!this.mine()) return;
    this.letGo();
    this.link.send({type: 'release'});
  }

  private key(event: KeyboardEvent) {
    const {code, key, repeat} = event, mine = this.mine();
    const shortcut = event.ctrlKey || event.altKey || event.metaKey || event.getModifierState('AltGraph') || /^(Control|Alt|AltGraph|Meta|OS)$/.test(key);
    const act = this.hands.press({code, key, repeat, shortcut, own: own(event), may: mine}, performance.now());
    if (act === 'stop') {
      // Whatever moves the robot ends; nobody needs control for that.
      this.letGo();
      if (!repeat) this.link.stop();
    } else if (!act || !mine) {
      if (mine && !repeat) this.sample();
      return;
    } else if (act === 'constant') {
      if (!repeat) this.constant();
    } else if (act === 'guard') {
      if (!repeat) this.link.note('The guard beside the robot always holds; it is not switched from here.', true);
    } else if (!repeat) {
      this.faster(firstStep * (Number(act === 'faster') - Number(act === 'slower')));
      this.sample();
    }
    event.preventDefault();
  }

  private faster(by: number) {
    this.keyVelocity = Math.max(-this.maxVelocity, Math.min(this.maxVelocity, this.keyVelocity + by));
  }

  // Tells the robot; 20 times a second, and at once after an event.
  private sample() {
    const {hands} = this, state = () => `${this.active} ${hands.pad} ${hands.padHint} ${hands.doubt}`, before = state();
    const now = performance.now(), was = this.active, pads = gamepads();
    this.hasPads = !!pads;
    this.velocity = this.rotation = 0;
    this.by = hands.sample(now, pads ?? [], this.mine());
    if (this.by === 'key') {
      const between = (more: Act, less: Act) => Number(hands.holds(more)) - Number(hands.holds(less));
      this.faster(rate * (now - this.sampled) / 1000 * between('faster', 'slower'));
      this.velocity = this.keyVelocity;
      this.rotation = keyTurn * between('left', 'right');
    } else {
      this.keyVelocity = 0;
      if (this.by) {
        this.velocity = hands.at.y * this.maxVelocity;
        this.rotation = -hands.at.x * Math.min(1, this.link.data<RobotDescription>('robot/description')?.max_rotation_velocity ?? 1);
      }
    }
    this.sampled = now;
    this.active = this.by !== '';
    if (this.active && !was) this.since = now;
    if (this.mine())
      this.link.sendSample({type: 'drive', number: ++this.number, at: now / 1000, active: this.active,
                      velocity: this.velocity, rotation: this.rotation,
                      cycle: this.link.data<RobotState>('robot/state')?.stamp.cycle ?? 0});
    if (this.mine() || before !== state())
      for (const listener of this.listeners) listener();
  }
}
