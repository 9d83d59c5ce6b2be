// The strangers that programs tell of: exact, without a browser. `npm test`
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {transformSync} from 'esbuild';

const {code} = transformSync(readFileSync(new URL('../src/strangers.ts', import.meta.url)), {loader: 'ts'});
const {strangersIn} = await import(`data:text/javascript,${encodeURIComponent(code)}`);

test('nobody, where no program tells of strangers', () => {
  assert.deepEqual(strangersIn([{name: 'bridge', reason: ''}, {name: 'vision', reason: 'no camera (0 packets in 3 s)'}]), []);
});

test('each address once, with who hears it', () => {
  assert.deepEqual(strangersIn([
    {name: 'bridge', reason: 'no robot; strangers are kept out: 10.0.0.7 (3120 packets in 60 s, the last 2 s ago), other addresses (100 packets in 5 s, the last 9 s ago); the certificate expires (soon)'},
    {name: 'intentions', reason: 'strangers are kept out: 10.0.0.7 (3100 packets in 61 s, the last 0 s ago)'},
  ]), [
    {address: '10.0.0.7', packets: 3120, during: 61, ago: 0, by: ['bridge', 'intentions']},
    {address: 'other addresses', packets: 100, during: 5, ago: 9, by: ['bridge']},
  ]);
});
