// The hold of a person's hands on keys, on the stick of the page and on gamepads; of events and times alone,
// without a browser. One rule: a thing is held from a press that this page has seen until its release, or until
// its release may have been missed. Then nothing is held, and each thing has to be pressed again.

export const period = 50;    // [ms] of the samples
const late = 400;            // [ms] a page that stood still for so long may have missed a release
const quiet = 200;           // [ms] at least, until a key that repeats no more is let go
const unproven = 10_000;     // [ms] a key that does not repeat counts, after the keyboard's newest event
const silence = 5000;        // [ms] a held gamepad that says nothing may be out of reach
const deadZone = 0.12;       // of a gamepad's stick

export type Act = 'faster' | 'slower' | 'left' | 'right' | 'keep' | 'stop' | 'constant' | 'guard';
// By the place on the keyboard (KeyboardEvent.code), whatever letter the layout has there.
const acts: {[code: string]: Act} = {
  KeyI: 'faster', ArrowUp: 'faster', Numpad8: 'faster', KeyM: 'slower', ArrowDown: 'slower', Numpad2: 'slower',
  KeyJ: 'left', ArrowLeft: 'left', Numpad4: 'left', KeyL: 'right', ArrowRight: 'right', Numpad6: 'right',
  Period: 'keep', KeyK: 'stop', Space: 'stop', KeyG: 'constant', KeyC: 'guard',
};
const drives = (act: Act) => act !== 'stop' && act !== 'constant' && act !== 'guard';

export interface Press {
  code: string; key: string; repeat: boolean;
  shortcut: boolean;   // with Ctrl, Alt, AltGr or Meta, or one of these itself
  own: boolean;        // the element with the focus uses this key itself
  may: boolean;        // this page has control
}
export interface Pad {
  index: number; id: string; mapping: string; timestamp?: number;
  axes: readonly number[]; buttons: readonly {pressed: boolean}[];
}
export interface At { x: number; y: number }   // [-1, 1], y ahead

// The buttons that are to be held on a gamepad, for people too. A stick alone may drift, or lie on its side.
// The standard mapping names them; a joystick has its trigger first. Others are not known.
export function deadMan({mapping, id}: Pad): {buttons: number[]; name: string} | undefined {
  if (mapping === 'standard') return {buttons: [4, 5, 6, 7], name: 'a shoulder button'};
  if (/joystick|attack 3|extreme 3d|t\.16000m/i.test(id) && !/generic|pad/i.test(id)) return {buttons: [0], name: 'the trigger, its first button,'};
  return undefined;
}

export class Hands {
  doubt = '';                // why all was let go, until the next press
  at: At = {x: 0, y: 0};     // of the stick, or of the gamepad's, while one is held
  pad = '';                  // the gamepad's name
  padHint = '';

  private held = new Set<string>();        // places of keys that drive
  private down = new Set<string>();        // places of all keys that are down, as far as known
  // Only the key that was pressed last repeats, and not on each keyboard.
  private newest = '';
  private newestAt = 0;
  private repeats = 0;
  private first = new Map<string, number>();   // [ms] until the first repeat, of keys that have repeated
  private gap = 400;                       // [ms] the slowest of the recent repeats
  private due = 0;                         // when the next event of a key is due
  private pointer?: number;                // on the stick
  private free = new Set<string>();        // gamepads that were seen with nothing held
  private driver = '';                     // the gamepad that is held
  private sign = '';                       // of its life
  private there = () => true;
  private signAt = 0;
  private sampled = 0;

  // The meaning of a press or repeat; '': none.
  press({code, key, repeat, shortcut, own, may}: Press, now: number): Act | '' {
    this.down.add(code);
    if (shortcut) {   // it may take the release of another key for itself
      this.letGo('Ctrl, Alt or Meta was pressed');
      return '';
    }
    if (!repeat) {
      const first = this.first.get(code);
      this.due = now + (first === undefined ? unproven : 1.5 * first + quiet);
      this.repeats = 0;
    } else if (code !== this.newest) {
      this.due = now + unproven;
      this.repeats = 1;
    } else {
      if (this.repeats++ === 0) this.first.set(code, now - this.newestAt);
      else this.gap = Math.max(now - this.newestAt, 0.8 * this.gap);
      this.due = now + Math.max(quiet, 3 * this.gap);
    }
    this.newest = code;
    this.newestAt = now;
    if (own) return '';
    // On a keyboard with other letters the stop is at its letter, too.
    const act = acts[code] ?? (/^[kK ]$/.test(key) ? 'stop' : '');
    if (act && drives(act) && may && !repeat) {
      this.held.add(code);
      this.doubt = '';
    }
    return act;
  }
  // Counts with any focus and any other key.
  release(code: string, now: number) {
    if (!this.down.delete(code)) this.letGo('a key was let go whose press was not seen');
    this.held.delete(code);
    this.newest = '';
    this.due = now + unproven;
  }

  // One pointer holds the stick, while that is there; another one does not count.
  grasp(pointer: number, at: At, there = () => true) {
    if (this.pointer !== undefined) return;
    this.pointer = pointer;
    this.there = there;
    this.at = at;
    this.doubt = '';
  }
  move(pointer: number, at: At, pressed: boolean) {
    if (pointer !== this.pointer) return;
    if (pressed) this.at = at;
    else this.drop(pointer);
  }
  drop(pointer: number) {
    if (pointer === this.pointer) this.pointer = undefined;
  }

  letGo(why = '') {
    if (this.held.size > 0 || this.pointer !== undefined || this.driver) this.doubt = why;
    this.held.clear();
    this.pointer = undefined;
    this.driver = '';
  }

  holds(act: Act): boolean { return [...this.held].some(code => acts[code] === act); }

  // Held now. Call it each period, and after each event.
  sample(now: number, pads: Pad[], may: boolean): '' | 'stick' | 'key' | 'gamepad' {
    const since = now - this.sampled;
    this.sampled = now;
    if (since > late) this.letGo('this page stood still for a moment');
    else this.due += Math.max(0, since - period);   // events may wait behind this sample
    if (!may) this.letGo(this.doubt = '');
    if (this.held.size > 0 && now > this.due) {
      if (this.repeats === 0) this.first.delete(this.newest);
      this.letGo('the keyboard no longer says that the key is held');
    }
    const pad = this.choose(pads, now);
    if (!this.there()) this.pointer = undefined;
    if (this.pointer !== undefined) return 'stick';
    if (this.held.size > 0) return 'key';
    if (!pad) return '';
    const dead = (v = 0) => Math.abs(v) < deadZone ? 0 : v;
    this.at = {x: dead(pad.axes[0]), y: dead(-(pad.axes[1] ?? 0))};
    return 'gamepad';
  }

  // The gamepad that drives. Another one takes over only once it was seen with nothing held.
  private choose(pads: Pad[], now: number): Pad | undefined {
    const name = (p: Pad) => `${p.index} ${p.id}`;
    const pressed = pads.filter(p => deadMan(p)?.buttons.some(i => p.buttons[i]?.pressed));
    const pad = pressed.find(p => name(p) === this.driver) ?? pressed.find(p => this.free.has(name(p)));
    const driver = pad ? name(pad) : '';
    this.free = new Set(pads.filter(p => !pressed.includes(p)).map(name));
    const shown = pad ?? pressed[0] ?? pads.find(deadMan) ?? pads[0];
    const sign = pad ? [pad.timestamp, ...pad.axes].join() : '';
    if (driver !== this.driver || sign !== this.sign) this.signAt = now;
    if (driver && driver !== this.driver) this.doubt = '';
    this.driver = driver;
    this.sign = sign;
    const silent = now - this.signAt > silence;
    this.pad = shown ? shown.id.replace(/\s*\(.*/, '').slice(0, 40) : '';
    this.padHint = !shown || pad && !silent ? ''
      : pad ? 'it says nothing; move its stick, or press its button again'
      : pressed.length > 0 ? 'let go of all gamepads first'
      : deadMan(shown) ? `hold ${deadMan(shown)!.name} to drive`
      : 'its buttons have no names here, so it does not drive; the command saphira drive knows more of them';
    return silent ? undefined : pad;
  }
}
