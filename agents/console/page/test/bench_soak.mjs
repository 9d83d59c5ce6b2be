// run bench-soak FOLDER [--json] [--minutes N]: the robot patrols with its camera on, before two viewers, of which one has a slow line, and a recorder. One
// JSON object: late cycles and memory by program, and the pictures that each viewer got.
import {mkdtempSync, readFileSync, readdirSync, readlinkSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {basename, join} from 'node:path';
import {chromium} from 'playwright-core';
import {link} from './link.mjs';
import {end, ended, output, sleep, start, until} from './processes.mjs';

const slow = {delay: 250, spread: 50, loss: 0.05, rate: 60e3};
const settled = 5;   // [min] until memory counts as that of the beginning

const words = process.argv.slice(2).filter(word => word !== '--json'), minutes = Number(words[1] ?? 60);
if (!(minutes > 0) || words.length > 2 || (words.length && words[0] !== '--minutes')) {
  console.error('saphira-bench-soak: expected --json, or --minutes N');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'saphira-soak-')), name = `soak-${process.pid}`, robot = ['--robot', name];
const recording = join(folder, 'hour.mcap'), children = [];

// [MB] of each program of this robot, its share of what it has in common with others.
function memory() {
  const sizes = {};
  for (const id of readdirSync('/proc').filter(each => /^\d+$/.test(each)))
    try {
      const program = basename(readlinkSync(`/proc/${id}/exe`));
      if (!program.startsWith('saphira') || !readFileSync(`/proc/${id}/cmdline`, 'utf8').includes(name)) continue;
      const size = Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, 'utf8'))[1]) / 1000;
      sizes[program] = Math.round(10 * size + 10 * (sizes[program] ?? 0)) / 10;
    } catch { /* it has ended meanwhile */ }
  return sizes;
}
// Round the offices, and again where that ends.
const ends = [];
let over = false, goal;
function patrol() {
  goal = start('saphira', ...robot, 'goal', 'patrol', 'places=N1, S3, N3, S2', 'rounds=1000');
  let last = '';
  goal.stdout.on('data', data => { last = String(data).trim().split('\n').at(-1).trim() || last; });
  goal.on('exit', () => {
    if (over) return;
    ends.push(last);
    setTimeout(patrol, 1000);
  });
}
async function status() {
  const asked = start('saphira', ...robot, 'status', '--json');
  let told = '';
  asked.stdout.on('data', data => { told += data; });
  await ended(asked);
  return JSON.parse(told);
}

let browser;
try {
  const up = start('saphira', ...robot, 'up', 'demo', '--set', `port=${20_000 + process.pid % 500 * 20}`);
  children.push(up);
  const address = new URL(await until('the address', () => output().match(/open (http:\S+)/)?.[1]));
  patrol();
  children.unshift(start('saphira-record', ...robot, recording));
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  const pictures = [0, 0];
  for (const [viewer, port] of [address.port, (await link(address.port, slow)).port].entries()) {
    const page = await (await browser.newContext({viewport: {width: 1280, height: 800}, reducedMotion: 'reduce'})).newPage();
    page.setDefaultTimeout(120_000);
    page.on('websocket', socket => socket.on('framereceived', ({payload}) => { pictures[viewer] += typeof payload !== 'string'; }));
    await page.goto(`http://localhost:${port}/${address.hash}`);
    await page.locator('.link.live').waitFor();
    await page.getByRole('button', {name: 'Camera', exact: true}).click();
  }
  let first;
  const begun = Date.now(), before = pictures.slice();
  for (let minute = 1; minute <= minutes; ++minute) {
    await sleep(begun + 60_000 * minute - Date.now());
    if (minute <= Math.max(1, Math.min(settled, minutes / 2))) first = memory();
    console.error(`${minute} min: ${JSON.stringify(memory())}`);
  }
  const state = await status();
  console.log(JSON.stringify({benchmark: 'soak', minutes, late_cycles: Object.fromEntries(state.programs.map(each => [each.name, each.late_cycles])),
    mb_first: first, mb_last: memory(),
    pictures_per_s: pictures.map((count, viewer) => Math.round((count - before[viewer]) / 6 / minutes) / 10),
    recording_mb: Math.round(statSync(recording).size / 1e6), goal_ends: ends}));
} finally {
  over = true;
  await browser?.close();
  await end(goal);
  for (const child of children) await end(child);
  rmSync(folder, {recursive: true, force: true});
}
process.exit(0);
