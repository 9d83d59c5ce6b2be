// The history of the link: exact, without a browser. `npm test`
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {transformSync} from 'esbuild';

const {code} = transformSync(readFileSync(new URL('../src/history.ts', import.meta.url)), {loader: 'ts'});
const {History, span} = await import(`data:text/javascript,${encodeURIComponent(code)}`);
const state = (cycle, more = {}) => ({epoch: 1, cycle, packets: 10, bad: 0, ...more});

test('the worst of each second, and the cycles between that did not come', () => {
  const history = new History();
  history.heard(10_000, state(100), 20);
  history.heard(10_100, state(101), 90);
  history.heard(10_400, state(104, {bad: 2}), 30);
  history.trip(10_500, 15);
  history.trip(10_900, 45);
  history.heard(11_000, state(105, {packets: 7, bad: 3}), 25);
  const series = history.series(12_500);
  assert.equal(series.length, span);
  assert.deepEqual(series.at(-2), {age: 90, trip: 45, heard: 3, missed: 2, packets: 10, bad: 2});
  assert.deepEqual(series.at(-1), {age: 25, trip: 0, heard: 1, missed: 0, packets: 7, bad: 1});
  assert.equal(series.at(-3), undefined);
});

test('a cycle that comes again, or another epoch, is no loss', () => {
  const history = new History();
  history.heard(1000, state(100, {bad: 9}), 0);
  history.heard(1050, state(100), 0);
  history.heard(1100, state(99), 0);
  history.heard(1200, state(5000, {epoch: 2}), 0);
  assert.deepEqual(history.series(2000).at(-1), {age: 0, trip: 0, heard: 2, missed: 0, packets: 10, bad: 0});
});

test('a silence is a gap, and what is older than the span is forgotten', () => {
  const history = new History();
  history.heard(1000, state(1), 5);
  history.heard(4000, state(31), 5);
  assert.deepEqual(history.series(5000).slice(-4).map(s => s?.missed), [0, undefined, undefined, 29]);
  history.trip(1000 * (span + 3), 1);
  assert.deepEqual(history.series(1000 * (span + 4)).filter(s => s).map(s => s.heard), [1, 0]);
  assert.equal(history.seconds.size, 2);
});
