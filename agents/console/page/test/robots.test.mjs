// The way from the list of robots to another robot's page: exact, without a browser. `npm test`
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {transformSync} from 'esbuild';

const {code} = transformSync(readFileSync(new URL('../src/robots.ts', import.meta.url)), {loader: 'ts'});
const {wayTo} = await import(`data:text/javascript,${encodeURIComponent(code)}`);

// address and host of the other console; the name of this page's host; its machine.
for (const [address, host, here, machine, expected] of [
  ['http://localhost:8643/', 'lab', 'localhost', 'lab', 'http://localhost:8643/'],
  ['http://localhost:8643/', 'lab', '127.0.0.1', 'lab', 'http://localhost:8643/'],
  ['http://localhost:8643/', 'lab', 'lab', 'lab', ''],             // a browser elsewhere
  ['http://localhost:8643/', 'other', 'localhost', 'lab', ''],
  ['http://lab:8643/', 'lab', '10.0.0.7', 'lab', 'http://10.0.0.7:8643/'],
  ['https://lab:8643/', 'lab', '10.0.0.7', 'lab', 'https://lab:8643/'],   // the name of its certificate
  ['https://other:8642/', 'other', 'localhost', 'lab', 'https://other:8642/'],
  ['', '', 'localhost', 'lab', ''],
  ['nonsense', 'lab', 'localhost', 'lab', ''],
  ['http://', 'lab', 'localhost', 'lab', ''],
  ['http://[', 'other', 'localhost', 'lab', ''],
  ['//other:8642/', 'other', 'localhost', 'lab', ''],
  ['javascript:alert(1)', 'lab', 'localhost', 'lab', ''],
  ['data:text/html,hello', 'lab', 'localhost', 'lab', ''],
  ['file://localhost/etc/passwd', 'lab', 'localhost', 'lab', ''],
])
  test(`${address} of ${host}, seen from ${here} of ${machine}`, () => {
    const way = wayTo({address, host}, {hostname: here}, machine);
    assert.equal(way.address, expected);
    assert.equal(way.why === '', expected !== '');
  });
