// Zones and places in the words of `saphira map`, and their undoing: exact, without a browser. `npm test`
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {buildSync} from 'esbuild';

const {outputFiles: [{text}]} = buildSync({entryPoints: [new URL('../src/map_edit.ts', import.meta.url).pathname], bundle: true, write: false, format: 'esm'});
const {add, facing, lineOf, placeOf, remove, toUndo, undo, zoneOf} = await import(`data:text/javascript,${encodeURIComponent(text)}`);

const zone = (rule, from, to, name, speed) => lineOf({...zoneOf({kind: 'zone', rule, from, to}, name, speed), id: 7});
test('the line of a zone between two corners', () => {
  for (const [rule, from, to, line] of [
    ['ZONE_KEEP_OUT', [4, 1], [1, 3], 'ZONE (7) 2500, 2000, 0.0, 3000, 2000 keep-out'],
    ['ZONE_SLOW', [0, 0], [1, 0.001], 'ZONE (7) 500, 1, 0.0, 1000, 100 slow 150'],
    ['ZONE_ONE_WAY', [0, 0], [3, 1], 'ZONE (7) 1500, 500, 0.0, 3000, 1000 one-way'],
    ['ZONE_ONE_WAY', [3, 0], [0, 1], 'ZONE (7) 1500, 500, 180.0, 3000, 1000 one-way'],
    ['ZONE_ONE_WAY', [0, 4], [1, 0], 'ZONE (7) 500, 2000, -90.0, 4000, 1000 one-way'],
    ['ZONE_PREFERRED', [0, 0], [1, 4], 'ZONE (7) 500, 2000, 0.0, 1000, 4000 preferred'],
  ])
    assert.equal(zone(rule, ...[from, to].map(([x, y]) => ({x, y})), '', 0.15), line);
  assert.equal(zone('ZONE_KEEP_OUT', {x: 0, y: 0}, {x: 1, y: 1}, 'the lab'), 'ZONE (7) 500, 500, 0.0, 1000, 1000 keep-out "the lab"');
  assert.equal(lineOf({...placeOf({x: 1.5, y: -2}, 'dock'), id: 3}), 'POS (3) 1500, -2000, 0.0 "dock"');
  assert.equal(facing({from: {x: 1, y: 1}, to: {x: 1, y: 0}}), -Math.PI / 2);
});

test('what was added is removed, and what was removed is put back, the newest first; a refused change is not undone', async () => {
  const asked = [];
  let puts = 0;
  const link = {
    well: true,
    data: () => ({artifacts: [{id: 4}, {id: 9}]}),
    ask: async ({type, words}) => {
      asked.push(`${type} ${words}`);
      return {well: link.well, text: '', id: words.startsWith('put') ? `${10 + puts++}` : ''};
    },
  };
  const dock = placeOf({x: 1, y: 2}, 'dock');
  await add(link, dock);
  assert.equal(toUndo(), 'adding place dock');
  assert.deepEqual(await add(link, placeOf({x: 1, y: 2}, 'wet "floor"')),
    {well: false, text: 'A name has no quotation marks: a map file cannot hold them.', id: ''});
  assert.equal(toUndo(), 'adding place dock');
  await remove(link, {...dock, id: 10});
  assert.equal(toUndo(), 'removing place dock');
  link.well = false;
  await add(link, dock);
  await undo(link);
  assert.equal(toUndo(), 'removing place dock');
  link.well = true;
  await undo(link);
  await undo(link);
  assert.equal(toUndo(), '');
  const put = id => `map put "POS (${id}) 1000, 2000, 0.0 \\"dock\\""`;
  assert.deepEqual(asked, [put(10), 'map remove 10', put(10), put(10), put(10), 'map remove 13']);
});
