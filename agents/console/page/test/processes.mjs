// Programs of the product, and waiting for conditions.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import net from 'node:net';
import {join} from 'node:path';

const limit = 30_000;        // [ms] generous: for broken runs
let said = '';

export const output = () => said;
export const sleep = time => new Promise(resolve => setTimeout(resolve, time));
export async function until(what, condition) {
  const end = Date.now() + limit;
  while (Date.now() < end) {
    const value = await condition();
    if (value) return value;
    await sleep(20);
  }
  assert.fail(`not seen within ${limit / 1000} s: ${what}\n${said.slice(-2000)}`);
}
export function start(program, ...words) {
  const child = spawn(join(process.env.SAPHIRA_BIN_DIR, program), words);
  for (const stream of [child.stdout, child.stderr]) stream.on('data', data => { said += data; });
  return child;
}
// The robot stands within 0.5 s, and a row of the trace. A busy machine adds to it, so that the time decides only
// where the machine has nothing else to do: SAPHIRA_QUIET=1.
export function inTime(stands) {
  assert.ok(stands <= (process.env.SAPHIRA_QUIET ? 0.6 : Infinity), `stands after ${stands} s`);
}
export const ended = child => child.exitCode !== null || child.signalCode !== null
  ? undefined : new Promise(resolve => child.on('exit', resolve));
// Also one that is stopped.
export async function end(child) {
  if (!child) return;
  child.kill('SIGCONT');
  child.kill('SIGTERM');
  await ended(child);
}

const stands = row => Math.abs(row.velocity) < 0.01 && Math.abs(row.rotation) < 0.02;

// The simulator's trace (--trace): what is true, a row for each cycle of 0.1 s.
export function trace(file) {
  const rows = () => readFileSync(file, 'utf8').split('\n').slice(1, -1)
    .map(row => row.split(',').map(Number)).map(row => ({cycle: row[0], velocity: row[4], rotation: row[5]}));
  return {
    rows,
    now: () => rows().at(-1)?.cycle ?? 0,
    speed: () => Math.abs(rows().at(-1)?.velocity ?? 0),
    // [s] from a cycle on; undefined while it moves.
    stood: from => {
      const found = rows().find(row => row.cycle >= from && stands(row));
      return found && (found.cycle - from) / 10;
    },
    // It moves after it has stood for 0.5 s, from a cycle on.
    drivesOn: from => /00000+.*1/.test(rows().filter(row => row.cycle >= from).map(row => stands(row) ? '0' : '1').join('')),
  };
}

// A simulated robot with its bridge and gateway, and what is true of it; in `self`.
export async function rig(self, folder, robot, {camera = false, console = []} = {}) {
  const line = join(folder, robot), rows = `${line}.csv`, lens = `${line}.camera`;
  Object.assign(self, trace(rows));
  const simulator = start('saphira-sim', '--world', 'arena', '--socket', line, '--trace', rows, ...(camera ? ['--camera-socket', lens] : []));
  const bridge = start('saphira-bridge', '--robot', robot, '--link', line);
  self.gateway = start('saphira-console', '--robot', robot, '--port', '0', ...console);
  self.children = [self.gateway, ...(camera ? [start('saphira-camera', '--robot', robot, '--socket', lens)] : []), bridge, simulator];
  let told = '';
  self.gateway.stdout.on('data', data => { told += data; });
  const [address, port, key] = await until('the address', () => told.match(/https?:\/\/localhost:(\d+)\/#(\w+)/));
  return Object.assign(self, {address, port: Number(port), key});
}

// Ports of this machine that nobody listens at.
export async function freePorts(count) {
  const servers = [...Array(count)].map(() => net.createServer());
  await Promise.all(servers.map(server => new Promise(resolve => server.listen(0, '127.0.0.1', resolve))));
  const found = servers.map(server => server.address().port);
  await Promise.all(servers.map(server => new Promise(resolve => server.close(resolve))));
  return found;
}
