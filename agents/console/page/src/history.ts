// The link over the last minutes, by the second: between page and robot, and the robot's own. Times of any steady clock [ms].
export const span = 180;   // [s]
export interface Second {
  age: number;      // [ms] of the oldest state when it came
  trip: number;     // [ms] the slowest round trip of a command [0: none]
  heard: number;    // cycles
  missed: number;   // cycles between those, which did not come
  packets: number;  // a second, of the robot's own link
  bad: number;      // of them ignored, since the second before
}
interface State { epoch: number; cycle: number; packets: number; bad: number }

export class History {
  private seconds = new Map<number, Second>();
  private last?: State;

  private second(now: number): Second {
    const at = Math.floor(now / 1000);
    let one = this.seconds.get(at);
    if (!one) {
      this.seconds.set(at, one = {age: 0, trip: 0, heard: 0, missed: 0, packets: 0, bad: 0});
      for (const old of this.seconds.keys()) if (old <= at - span) this.seconds.delete(old);
    }
    return one;
  }
  // A state of the robot has come, so old.
  heard(now: number, state: State, age: number) {
    const one = this.second(now), last = this.last?.epoch === state.epoch ? this.last : undefined;
    if (last && state.cycle <= last.cycle) return;
    this.last = state;
    one.age = Math.max(one.age, age);
    ++one.heard;
    one.packets = state.packets;
    if (!last) return;
    one.missed += state.cycle - last.cycle - 1;
    one.bad += Math.max(0, state.bad - last.bad);
  }
  trip(now: number, time: number) {
    const one = this.second(now);
    one.trip = Math.max(one.trip, time);
  }
  // The whole seconds of the last minutes, the oldest first; undefined: nothing came.
  series(now: number): (Second | undefined)[] {
    const end = Math.floor(now / 1000);
    return Array.from({length: span}, (_, i) => this.seconds.get(end - span + i));
  }
}
