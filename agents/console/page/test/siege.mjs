// A long siege of the gateway of a whole robot: broken HTTP, broken frames, messages that are nearly right, slow
// and many connections. It tells what the attack cost the robot: cycles that came late, the gateway's memory, and
// programs that had to be started again, beside periods of a minute without an attack. By hand: run siege SECONDS [ATTACKS A SECOND] [SEED].
import {execFile} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {promisify} from 'node:util';
import {end, ended, output, sleep, start, until} from './processes.mjs';
import {frame} from './socket.mjs';

const [seconds, rate, seed] = [[600, 0], [50, 1], [1, 2]].map(([usual, at]) => Number(process.argv[2 + at] ?? usual));
const folder = mkdtempSync(join(tmpdir(), 'saphira-siege-'));
process.env.SAPHIRA_RUN = folder;
process.env.SAPHIRA_ROBOT = `siege-${process.pid}`;
const saphira = join(process.env.SAPHIRA_BIN_DIR, 'saphira');
const run = async (...words) => (await promisify(execFile)(saphira, words)).stdout;

let state = seed;
const random = most => (state = (Math.imul(state, 1103515245) + 12345) >>> 0, Math.floor(state / 2 ** 32 * most));
const one = list => list[random(list.length)];

function mutated(bytes) {
  let result = Buffer.from(bytes);
  for (let changes = random(6); changes > 0; --changes) {
    const at = random(result.length + 1), size = 1 + random(8);
    const [before, after] = [result.subarray(0, at), result.subarray(at)];
    switch (random(5)) {
      case 0: if (at < result.length) result[at] ^= 1 << random(8); break;
      case 1: result = Buffer.concat([before, Buffer.from(Array.from({length: size}, () => random(256))), after]); break;
      case 2: result = Buffer.concat([before, after.subarray(size)]); break;
      case 3: result = Buffer.concat([before, after, after]); break;
      default: result = before;
    }
  }
  return result;
}

let port, key;
const requests = [
  () => `GET ${one(['/', '/console.js', '/%00', '/../x', '/simulator.html'])} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n`,
  () => `POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: ${one([0, 5, 1e9, -1])}\r\n\r\nhello`,
  () => `GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nffffffff\r\nx\r\n`,
  () => `GET / HTTP/1.1\r\n${'X-Long: y\r\n'.repeat(random(400))}\r\n`,
  () => upgrade(one(['saphira.commands', 'saphira.telemetry', 'other'])),
];
const upgrade = protocol => `GET / HTTP/1.1\r\nHost: localhost:${port}\r\nOrigin: http://localhost:${port}\r\nConnection: Upgrade\r\n` +
  'Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n' +
  `Sec-WebSocket-Protocol: ${protocol}\r\n\r\n`;
// The messages of the fuzzer of the console's core, without those that would change what the robot does in the end.
const messages = readFileSync(new URL('../../../../tests/fuzz/console.seed', import.meta.url), 'utf8').trim().split('\n')
  .filter(line => !/"type":"(estop|cancel|goal|say|process|map|hand_back)"/.test(line));

const count = {connections: 0, frames: 0};
function attack() {
  ++count.connections;
  const socket = net.connect(port, '127.0.0.1').on('error', () => {}).on('data', () => {});
  const end = () => socket.destroy();
  if (random(2)) {
    socket.write(mutated(one(requests)()));
  } else {
    const protocol = one(['saphira.commands', 'saphira.telemetry']);
    socket.write(upgrade(protocol));
    const say = message => { ++count.frames; socket.write(message); };
    socket.once('data', () => {
      if (random(4)) say(frame(JSON.stringify({type: 'hello', key: random(3) ? key : 'wrong', name: 'mallory'})));
      for (let left = random(30); left > 0; --left) {
        const text = one(messages);
        say(random(2) ? frame(mutated(text)) : mutated(frame(text, one([1, 1, 1, 0, 2, 8, 9, 10, 15]))));
      }
    });
  }
  setTimeout(end, one([0, 5, 50, 500, 5000]));
}
async function crowd() {
  const sockets = Array.from({length: 1000}, () => net.connect(port, '127.0.0.1').on('error', () => {}));
  for (const socket of sockets) socket.write('GET / HTTP/1.1\r\nX-Slow: ');
  await sleep(2000);
  for (const socket of sockets) socket.destroy();
}

// A page that is only watched by somebody harmless: how long the gateway takes to answer.
const page = () => new Promise(resolve => {
  const begun = Date.now();
  http.get({host: '127.0.0.1', port, path: '/', agent: false, timeout: 10_000},
    response => response.resume().on('end', () => resolve(Date.now() - begun))).on('error', () => resolve(Infinity));
});
function used(pid) {   // ticks of 10 ms; of a process that is gone nothing is known
  try {
    return readFileSync(`/proc/${pid}/stat`, 'utf8').split(' ').slice(13, 15).reduce((sum, ticks) => sum + Number(ticks), 0);
  } catch {
    return NaN;
  }
}
const programs = async () => JSON.parse(await run('status', '--json')).programs;
async function period(name, length, each) {
  const before = await programs();
  const pid = before.find(one => one.name === 'console').pid, usedBefore = used(pid), begun = Date.now();
  const stop = begun + 1000 * length;
  let slowest = 0, unanswered = 0, memory = 0;
  for (let i = 1; Date.now() < stop; ++i) {
    await each(i);
    if (i % 100) continue;
    const took = await page();
    took === Infinity ? ++unanswered : slowest = Math.max(slowest, took);
    memory = Math.max(memory, (await programs()).find(one => one.name === 'console')?.rss_mb ?? 0);
  }
  const cpu = (used(pid) - usedBefore) / (Date.now() - begun) * 1000;
  await sleep(2000);   // the last status of each
  const after = await programs();
  const late = Object.fromEntries(after.map(program => [program.name,
    program.late_cycles - (before.find(one => one.name === program.name)?.late_cycles ?? 0)]).filter(([, cycles]) => cycles));
  const restarted = before.filter(program => !after.some(one => one.pid === program.pid)).map(program => program.name);
  const cycles = Math.max(...after.map(program => program.cycle)) - Math.max(...before.map(program => program.cycle));
  const sum = Object.values(late).reduce((sum, cycles) => sum + cycles, 0);
  console.log(JSON.stringify({period: name, seconds: length, cycles, late, restarted, slowest_page_ms: slowest, unanswered,
    gateway_mb: Math.round(memory), gateway_cpu_percent: Math.round(cpu), ...count}));
  return {seconds: length, cycles, late: sum, restarted: restarted.length, unanswered};
}

const robot = start('saphira', 'up', 'office', '--set', 'port=0');
let patrol;
try {
  [, port, key] = await until('the address', () => output().match(/localhost:(\d+)\/#(\w+)/));
  await until('the intentions', async () => (await programs()).some(one => one.name === 'intentions' && one.state === 'running'));
  patrol = start('saphira', 'goal', 'patrol');
  await until('that the robot drives', () => /patrol/.test(output()));
  await sleep(5000);
  const length = Math.min(60, seconds), total = {};
  const add = (name, found) => {
    total[name] ??= {seconds: 0, cycles: 0, late: 0, restarted: 0, unanswered: 0};
    for (const part of Object.keys(total[name])) total[name][part] += found[part];
  };
  for (let done = 0; done < seconds; done += length) {
    add('quiet', await period('quiet', length, () => sleep(1000 / rate)));
    add('siege', await period('siege', length, async i => {
      attack();
      if (i === rate) await crowd();
      await sleep(1000 / rate);
    }));
  }
  console.log(JSON.stringify(total));
} finally {
  console.log(output().split('\n').filter(line => /ended|hung|started again/.test(line)).join('\n'));
  patrol?.kill('SIGTERM');
  await end(robot);
  rmSync(folder, {recursive: true, force: true});
}
