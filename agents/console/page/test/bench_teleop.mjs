// run bench-teleop FOLDER [--json] [--runs N]: an operator at the real page drives over good and bad links, with the camera on. For each link: the
// first page, the share of the time in which the robot moves while a key is held, the time until it stands after the release, the pictures
// and their age, and the bytes. What is true of the robot is read from the simulator's trace, whose rows are 0.1 s apart.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {chromium} from 'playwright-core';
import {link} from './link.mjs';
import {end, rig, sleep, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

const hold = 6, settle = 1, rest = 2.5;   // [s] a key is held; until its motion counts; until the next one
const links = [{}, {delay: 50, spread: 10}, {delay: 100, loss: 0.05}, {delay: 100, spread: 20, reorder: 0.1}, {delay: 250, spread: 50, loss: 0.05},
  {delay: 250, spread: 50, loss: 0.05, reorder: 0.1, rate: 250e3}];

const words = process.argv.slice(2), json = words.includes('--json'), given = words.indexOf('--runs');
const runs = given < 0 ? 3 : Number(words[given + 1]);
if (!(runs > 0) || words.some((word, i) => word !== '--json' && word !== '--runs' && i !== given + 1)) {
  console.error('saphira-bench-teleop: expected --json, or --runs N');
  process.exit(2);
}
const nameOf = bad => [`${bad.delay ?? 0}${bad.spread ? ` ± ${bad.spread}` : ''} ms`, bad.loss && `${100 * bad.loss} % lost`,
  bad.reorder && `${100 * bad.reorder} % reordered`, bad.rate && `${8 * bad.rate / 1e6} Mbit/s`].filter(Boolean).join(', ');
const quantile = (values, share) => values.length ? [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))] : null;
const round = (value, digits) => value === null ? null : Number(value.toFixed(digits));

const folder = mkdtempSync(join(tmpdir(), 'saphira-bench-')), robot = {};
let browser;
try {
  await rig(robot, folder, `bench-${process.pid}`, {camera: true});
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  // The time of each picture's capture: a second reader on a good link has no way to wait for.
  const captured = new Map(), headers = {Host: `localhost:${robot.port}`, Origin: `http://localhost:${robot.port}`};
  const results = [];
  let total = 0;   // to and fro, so that there is always room
  for (const bad of links) {
    const far = await link(robot.port, bad), near = await socketTo(robot.port, 'saphira.pictures', headers);
    near.take = bytes => {
      const {number, age, cycle} = JSON.parse(bytes.subarray(0, bytes.indexOf(10)).toString());
      captured.set(cycle, performance.now() - 1000 * age);
      near.say({type: 'ack', frame: number});
    };
    near.say({type: 'hello', key: robot.key, name: 'near'});
    const page = await (await browser.newContext({viewport: {width: 1280, height: 800}, reducedMotion: 'reduce'})).newPage();
    page.setDefaultTimeout(60_000);
    const pictures = [];
    page.on('websocket', socket => socket.on('framereceived', ({payload}) => {
      if (typeof payload === 'string') return;
      const {cycle} = JSON.parse(payload.subarray(0, payload.indexOf(10)).toString());
      if (cycle > (pictures.at(-1)?.cycle ?? 0)) pictures.push({at: performance.now(), cycle});   // an overtaken one is not shown
    }));
    const began = performance.now();
    // The gateway's own name: the link is no proxy that it could know.
    await page.goto(`http://localhost:${far.port}/#${robot.key}`);
    await page.locator('.link.live').waitFor();
    const first = (performance.now() - began) / 1000;
    await page.getByRole('button', {name: 'Camera', exact: true}).click();
    await page.locator('.camera figcaption').getByText(/old$/).waitFor();
    const takeControl = () => until('control', async () => {
      if (await page.getByText('You drive').count()) return true;
      const button = page.getByRole('button', {name: 'Drive', exact: true});
      if (await button.count()) await button.click({timeout: 1000}).catch(() => {});
      await sleep(500);
      return false;
    });
    await sleep(3000);
    const from = {at: performance.now(), pictures: pictures.length, down: far.down, up: far.up};
    const stops = [];
    let moving = 0, held = 0;
    for (let run = 0; run < runs; ++run) {
      await takeControl();
      const key = total++ % 2 ? 'm' : 'i', press = robot.now();
      await page.keyboard.down(key);
      await sleep(1000 * hold);
      const release = robot.now();
      await page.keyboard.up(key);
      await sleep(1000 * rest);
      const rows = robot.rows().filter(row => row.cycle > press + 10 * settle && row.cycle <= release);
      held += rows.length;
      moving += rows.filter(row => Math.abs(row.velocity) > 0.02).length;
      if (rows.length && Math.abs(rows.at(-1).velocity) > 0.02) stops.push(robot.stood(release) ?? rest);
    }
    const time = (performance.now() - from.at) / 1000, seen = pictures.slice(from.pictures);
    const ages = seen.filter(each => captured.has(each.cycle)).map(each => (each.at - captured.get(each.cycle)) / 1000);
    results.push({link: nameOf(bad), first_page_s: round(first, 2), moving_while_held: round(moving / Math.max(1, held), 2),
      stops: stops.length, stop_s: round(quantile(stops, 0.5), 1), stop_most_s: round(quantile(stops, 1), 1),
      pictures_per_s: round(seen.length / time, 1), picture_age_s: round(quantile(ages, 0.5), 2), picture_age_95_s: round(quantile(ages, 0.95), 2),
      down_kb_per_s: round((far.down - from.down) / time / 1000, 1), up_kb_per_s: round((far.up - from.up) / time / 1000, 1)});
    await page.context().close();
    near.socket.destroy();
  }
  const or = value => value ?? '-';
  if (json) console.log(JSON.stringify({benchmark: 'teleop', runs, held_s: hold, links: results}));
  else {
    console.log('| link, each way | first page [s] | moves while held | stands after the release [s]: half, most | pictures a second | their age [s]: half, 95 % | kB/s down, up |\n| --- | --- | --- | --- | --- | --- | --- |');
    for (const r of results)
      console.log(`| ${r.link} | ${r.first_page_s} | ${Math.round(100 * r.moving_while_held)} % | ${or(r.stop_s)}, ${or(r.stop_most_s)} | ${r.pictures_per_s} | ${or(r.picture_age_s)}, ${or(r.picture_age_95_s)} | ${r.down_kb_per_s}, ${r.up_kb_per_s} |`);
  }
} finally {
  await browser?.close();
  for (const child of robot.children ?? []) await end(child);
  rmSync(folder, {recursive: true, force: true});
}
process.exit(0);
