// The two connections to the gateway, and what has come by them.
import {barrier, socketOf, store, stored, storedKey} from './address';
import {History} from './history';
import {notify} from './notify';
import type {ConsoleInfo, ControlState, Goal, Grant, RobotState, ServiceStatus, Stamp} from './types';

export interface Item<T> {
  data: T;
  at: number;   // [ms] performance.now() of when it was true, as near as the page can tell
}
export interface Answer { well: boolean; text: string; id: string; file?: string }

const retry = 1000;      // [ms]
const furtherLanes = 5;  // for samples of driving
const mostWait = 2000;   // [ms] for them
const drift = 0.001;     // of two clocks, at the most
const settled = 1000;    // [ms] after a cut, until what was on its way has come
const pieceSize = 500;   // [letters] of a file
const mostGoals = 200;   // that are remembered
export const gone = 2000;   // [ms] nothing heard for so long: the connection is gone
const operatorName = 'saphira operator';

interface Frame { now: number; items: {t: string; k: string; a: number; d: unknown}[] }
interface Message { type: string; [member: string]: unknown }

export class Link {
  connected = false;         // the telemetry
  commanding = false;        // the commands
  barrier = '';              // why no connection of this page gets through
  mayWatch = true;
  mayDrive = false;
  mayOperate = false;
  id = 0;                    // of our operator, by the gateway
  operator = stored(operatorName);
  roundTrip = 0;             // [ms] [0: not known]
  refused = '';              // why the newest sample of driving did not count
  heard = -1e9;              // [ms] when the newest frame came
  stopping = false;          // an emergency stop was sent, and is not confirmed yet
  history = new History();
  delays: number[] = [];     // [ms] from the gateway to the pixels, of the newest robot states

  private topics = new Map<string, Map<string, Item<unknown>>>();
  private goals = new Map<string, Goal>();   // also those that were withdrawn
  private cut?: {since: number; back?: number; id: number; held: boolean; consoles: string[]};
  private before = {id: 0, held: false, consoles: [] as string[]};   // while the link was there
  private listeners: (() => void)[] = [];
  private noteListeners: ((text: string, well: boolean) => void)[] = [];
  private commands?: WebSocket;
  private lanes: WebSocket[] = [];   // further ones for samples
  private lane = 0;
  private ticket = '';
  readonly key = storedKey();
  private barred = 0;        // attempts in turn that something let not through
  private offset = NaN;      // [ms] our clock less the gateway's, with the quickest frame
  private offsetAt = 0;
  private quickest = Infinity;
  private references = 0;
  private waiting = new Map<number, (answer: Answer) => void>();

  constructor() {
    this.openTelemetry();
    this.openCommands();
    setInterval(() => this.ping(), 500);
  }

  get<T>(topic: string, key = ''): Item<T> | undefined {
    return this.topics.get(topic)?.get(key) as Item<T> | undefined;
  }
  data<T>(topic: string): T | undefined {
    return this.get<T>(topic)?.data;
  }
  all<T>(topic: string): [string, Item<T>][] {
    return [...(this.topics.get(topic) ?? [])] as [string, Item<T>][];
  }
  // What was asked under that id, also when it was withdrawn since.
  goal(id: string): Goal | undefined { return this.goals.get(id); }
  onFrame(listener: () => void) { this.listeners.push(listener); }
  onNote(listener: (text: string, well: boolean) => void) { this.noteListeners.push(listener); }

  drawn(delay: number) {
    this.delays.push(delay);
    if (this.delays.length > 1000) this.delays.shift();
  }

  rename(name: string) {
    this.operator = name.trim().slice(0, 20);
    store(operatorName, this.operator);
    this.send({type: 'rename', name: this.operator});
  }

  // False: nothing was sent, because there is no connection, or a slow one has much to send still. A
  // stop is sent in any case.
  send(message: Message): boolean {
    if (this.commands?.readyState !== WebSocket.OPEN) return false;
    if (this.commands.bufferedAmount > 2000 && message.type !== 'estop' && message.type !== 'stop') return false;
    this.commands.send(JSON.stringify(message));
    return true;
  }

  // Everybody's emergency stop, which is latched.
  estop() {
    this.stopping = this.send({type: 'estop'});
    navigator.vibrate?.(200);
    if (!this.stopping) this.note("NOT SENT: there is no connection. Stop the robot by its own switch.", false);
    this.tell();
  }
  // Everybody's stop of whatever moves the robot. One answer names who was stopped, a later one is a note.
  stop() {
    navigator.vibrate?.(200);
    void this.ask({type: 'stop'}).then(answer => this.note(answer.text, answer.well));
  }

  // Control, once the connections for samples are there: over one alone, a packet that is lost stops the robot.
  async takeControl(force: boolean) {
    this.openLanes();
    const end = performance.now() + mostWait;
    while (this.lanes.some(lane => lane.readyState === WebSocket.CONNECTING) && performance.now() < end)
      await new Promise(resolve => setTimeout(resolve, 20));
    this.send({type: 'take', force});
    setTimeout(() => this.mine() || this.closeLanes(), mostWait);
  }
  mine(): boolean { return this.id !== 0 && this.data<ControlState>('console/control')?.holder === this.id; }

  // A sample of driving, by several connections in turn: where one waits for what was lost on its way, the
  // others go on. The gateway takes the newest.
  sendSample(sample: object) {
    this.openLanes();
    const free = [this.commands, ...this.lanes].filter(s => s?.readyState === WebSocket.OPEN && s.bufferedAmount < 500);
    free[++this.lane % free.length]?.send(JSON.stringify(sample));
  }
  private openLanes() {
    if (this.ticket && this.lanes.length === 0)
      for (let i = 0; i < furtherLanes; ++i) this.openLane(i);
  }
  // Who does not drive leaves the places to others: a relay has few for one router.
  private closeLanes() {
    for (const lane of this.lanes.splice(0)) lane.close();
  }
  private openLane(i: number) {
    const socket = this.lanes[i] = socketOf('saphira.commands');
    const ticket = this.ticket;
    socket.onopen = () => socket.send(JSON.stringify({type: 'hello', key: this.key, name: this.operator, ticket}));
    socket.onmessage = event => {
      const message = JSON.parse(event.data as string);
      if (message.type === 'state') this.take(message);
    };
    socket.onclose = () => setTimeout(() => this.lanes[i] === socket && this.openLane(i), retry);
  }

  // A file, in pieces as the gateway takes them.
  async sendFile(type: string, name: string, text: string): Promise<Answer> {
    const letters = [...text], reference = ++this.references;
    for (let i = 0; ; i += pieceSize) {
      const more = i + pieceSize < letters.length;
      const piece = {type, name: [...name].slice(-50).join(''), text: letters.slice(i, i + pieceSize).join(''), more};
      if (!more) return this.ask(piece, reference);
      while (!this.send({...piece, reference})) {
        if (!this.commanding) return {well: false, text: 'There is no connection to the console.', id: ''};
        await new Promise(resolve => setTimeout(resolve, 20));
      }
    }
  }

  ask(message: Message, reference = ++this.references): Promise<Answer> {
    return new Promise(resolve => {
      if (!this.send({...message, reference}))
        return resolve({well: false, text: 'There is no connection to the console.', id: ''});
      this.waiting.set(reference, resolve);
      setTimeout(() => {
        if (this.waiting.delete(reference))
          resolve({well: false, text: 'Nobody has answered within 5 s.', id: ''});
      }, 5000);
    });
  }

  private openTelemetry() {
    const socket = socketOf('saphira.telemetry');
    socket.onopen = () => {
      this.topics.clear();
      this.offset = NaN;
      this.connected = true;
      this.barred = 0;
      this.barrier = '';
      socket.send(JSON.stringify({type: 'hello', key: this.key, name: this.operator}));
    };
    socket.onmessage = event => {
      const frame = JSON.parse(event.data as string);
      if (frame.seq === undefined) return this.greeted(frame);
      socket.send(JSON.stringify({type: 'ack', frame: frame.seq}));
      this.take(frame);
    };
    socket.onclose = () => {
      if (!this.connected) void this.askForBarrier();
      this.connected = false;
      this.tell();
      setTimeout(() => this.openTelemetry(), retry);
    };
  }

  // A gateway that has just come answers too: the second time counts.
  private async askForBarrier() {
    const why = await barrier();
    if (this.connected) return;
    this.barred = why ? this.barred + 1 : 0;
    this.barrier = this.barred > 1 ? why : '';
  }

  private openCommands() {
    const socket = this.commands = socketOf('saphira.commands');
    socket.onopen = () => {
      socket.send(JSON.stringify({type: 'hello', key: this.key, name: this.operator}));
    };
    socket.onmessage = event => this.takeCommand(JSON.parse(event.data as string));
    socket.onclose = () => {
      this.commanding = false;
      this.refused = '';
      this.id = 0;
      this.ticket = '';
      this.closeLanes();
      this.roundTrip = 0;
      this.stopping = false;
      this.tell();
      setTimeout(() => this.openCommands(), retry);
    };
  }

  private greeted(hello: {may_watch?: boolean}) {
    this.mayWatch = hello.may_watch !== false;
    this.tell();
  }

  // Of a time of the gateway, in ours [ms].
  when(now: number): number {
    return Number.isNaN(this.offset) ? performance.now() : 1000 * now + this.offset - this.way();
  }
  // [ms] of the quickest frame
  private way(): number { return Number.isFinite(this.quickest) ? this.quickest / 2 : 0; }

  // One connection may be held up behind another: an older state of the robot, or an older grant, changes nothing.
  private take(frame: Frame) {
    this.watch();  // as it was until now: this frame may be the first one after a cut
    const now = performance.now();
    const difference = now - 1000 * frame.now;
    this.offset = Number.isNaN(this.offset)
        ? difference : Math.min(difference, this.offset + drift * (now - this.offsetAt));
    this.offsetAt = now;
    this.heard = now;
    // How long it took: what it took longer than the quickest one, and half the quickest round trip.
    const took = difference - this.offset + this.way();
    for (const {t, k, a, d} of frame.items) {
      let items = this.topics.get(t);
      if (!items) this.topics.set(t, items = new Map());
      const stamp = (d as {stamp?: Stamp} | null)?.stamp, had = items.get(k)?.data as {stamp: Stamp} | undefined;
      if ((t === 'robot/state' || t === 'drive/grant') && stamp && had && stamp.epoch === had.stamp.epoch && stamp.cycle < had.stamp.cycle) continue;
      if (d === null) items.delete(k);
      else items.set(k, {data: d, at: now - a - took});
      if (t === 'robot/state' && d !== null) {
        const {stamp, motor_packets_per_s: packets, bad_packets: bad} = d as RobotState;
        this.history.heard(now, {...stamp, packets, bad}, a + took);
      }
      if (t === 'drive/grant' && (d as Grant | null)?.estopped) this.stopping = false;
      if (t === 'goals' && d !== null && !(d as Goal).withdrawn) this.remember(k, d as Goal);
    }
    this.tell();
  }

  private remember(id: string, goal: Goal) {
    this.goals.delete(id);
    this.goals.set(id, goal);
    if (this.goals.size > mostGoals) this.goals.delete(this.goals.keys().next().value!);
  }

  // Something of the console was heard lately.
  isThere(now = performance.now()): boolean { return this.connected && now - this.heard <= gone; }

  // After a cut: what it was, and what has become of control.
  private watch() {
    const now = performance.now();
    if (!this.isThere(now) || !this.commanding) {
      if (this.before.id > 0) this.cut = {...(this.cut ?? {since: this.heard, ...this.before}), back: undefined};
      return;
    }
    const control = this.data<ControlState>('console/control');
    const consoles = this.all<ServiceStatus>('system/status').filter(([, {data}]) => data.name === 'console').map(([key]) => key);
    const held = this.mine();
    if (this.before.held && control && !held) this.closeLanes();
    const cut = this.cut;
    if (cut) {
      cut.back ??= now;
      if (!control || now - cut.back < settled) return;
      this.cut = undefined;
      const others = consoles.length > 0 && cut.consoles.length > 0 && !consoles.some(key => cut.consoles.includes(key));
      const first = this.id < cut.id || others ? 'The console was started again: goals from its pages have ended.'
        : `The connection is back after ${Math.max(1, Math.round((cut.back - cut.since) / 1000))} s.`;
      const second = !this.mayDrive ? '' : !cut.held ? ' You had no control.'
        : held ? ' You still have control.' : ' You have lost control: press Drive to take it again.';
      this.note(first + second, !cut.held || held);
    }
    this.before = {id: this.id, held, consoles};
  }

  private takeCommand(message: {type: string; [name: string]: unknown}) {
    switch (message.type) {
      case 'hello':
        this.commanding = true;
        this.id = message.id as number;
        this.ticket = message.ticket as string;
        this.mayDrive = message.may_drive as boolean;
        this.mayOperate = message.may_operate as boolean;
        this.mayWatch = message.may_watch as boolean;
        break;
      case 'pong':
        this.roundTrip = performance.now() - (message.at as number);
        this.history.trip(performance.now(), this.roundTrip);
        this.quickest = Math.min(this.quickest, this.roundTrip);
        break;
      case 'state':
        return this.take(message as unknown as Frame);
      case 'drive':
        this.refused = message.refused as string;
        break;
      case 'note':
        this.note(message.text as string, false);
        break;
      case 'event':
        notify(this.data<ConsoleInfo>('console')?.robot ?? 'Saphira', message.text as string);
        break;
      case 'wrong':
        this.note('The console did not understand the page: ' + (message.why as string), false);
        break;
      case 'answer': {
        const answer = message as unknown as Answer & {reference: number};
        const waiting = this.waiting.get(answer.reference);
        if (waiting) {
          this.waiting.delete(answer.reference);
          waiting(answer);
        } else if (answer.text) {
          this.note(answer.text, answer.well);
        }
        break;
      }
    }
    this.tell();
  }

  note(text: string, well: boolean) {
    for (const listener of this.noteListeners) listener(text, well);
  }
  private tell() {
    for (const listener of this.listeners) listener();
  }
  private ping() {
    if (this.commanding) this.send({type: 'ping', at: performance.now()});
    this.watch();
    this.tell();
  }
}
