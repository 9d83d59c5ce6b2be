// run bench-console FOLDER [--json] [--artifacts N] [--seconds N]: the cost of the console with three pages and a large map, the delay from a packet
// to the pixels, and the frame rate of a page. The robot drives meanwhile: a static page costs less.
import {mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';
import {chromium} from 'playwright-core';
import {end, freePorts, output, sleep, start, until} from './processes.mjs';

const here = process.env.SAPHIRA_SOURCE_DIR ?? join(process.env.SAPHIRA_BIN_DIR, '../../..'), pages = 3;
const words = process.argv.slice(2), given = {'--artifacts': 4000, '--seconds': 20};
const json = words.includes('--json');
for (let i = 0; i < words.length; ++i) {
  if (words[i] === '--json') continue;
  if (!(words[i] in given) || !(Number(words[i + 1]) > 0)) {
    console.error('saphira-bench-console: expected --json, --artifacts N or --seconds N');
    process.exit(2);
  }
  given[words[i]] = Number(words[++i]);
}
const artifacts = given['--artifacts'], seconds = given['--seconds'];
const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];

// The map of the office with further walls, up to that number of artifacts.
function largeMap(file) {
  const office = readFileSync(join(here, 'config/maps/office.map'), 'utf8'), walls = [];
  for (let i = office.split('\n').filter(line => line && !line.startsWith(';')).length; i < artifacts; ++i)
    walls.push(`WALL ${500 * (i % 100)}, ${30000 + 500 * Math.floor(i / 100)}, ${30 * (i % 12)}, 400\n`);
  writeFileSync(file, office + walls.join(''));
}
// [s] of the processor.
const worked = id => {
  const fields = readFileSync(`/proc/${id}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) / 100;
};

const folder = mkdtempSync(join(tmpdir(), 'saphira-bench-')), name = `bench-console-${process.pid}`, children = [];
let browser;
try {
  largeMap(join(folder, 'large.map'));
  const [port] = await freePorts(1);
  children.push(start('saphira', '--robot', name, 'up', 'demo', '--set', `map=${join(folder, 'large.map')}`, '--set', `port=${port}`));
  const address = await until('the address', () => output().match(/open (http:\S+#\S+)/)?.[1]);
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  const open = async () => {
    const page = await (await browser.newContext({viewport: {width: 1280, height: 800}})).newPage();
    await page.goto(address);
    await page.locator('.link.live').waitFor();
    return page;
  };
  const page = await open();
  const first = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? 0);
  children.unshift(start('saphira', '--robot', name, 'goal', 'go', '16', '1'));
  await page.waitForFunction(() => saphira.data('map'));
  await sleep(3000);   // grids are there
  const features = await page.evaluate(() => saphira.data('map').artifacts.length);
  // One page: three that are drawn by software on one machine would slow each other.
  await page.evaluate(() => {
    saphira.delays.length = 0;
    window.frameTimes = [];
    (function next(at) { window.frameTimes.push(at); requestAnimationFrame(next); })(performance.now());
  });
  await sleep(1000 * seconds);
  const {delays, times} = await page.evaluate(() => ({delays: saphira.delays, times: window.frameTimes}));
  if (delays.length === 0 || times.length < 2)
    throw new Error('nothing was drawn');
  const intervals = times.slice(1).map((at, i) => at - times[i]);
  while (browser.contexts().length < pages) await open();
  await sleep(3000);
  const gateway = readdirSync('/proc').find(id => {
    try {
      return /^\d+$/.test(id) && readFileSync(`/proc/${id}/comm`, 'utf8').startsWith('saphira-console')
        && readFileSync(`/proc/${id}/environ`, 'utf8').includes(`SAPHIRA_ROBOT=${name}\0`);
    } catch { return false; /* it has ended meanwhile */ }
  });
  const before = worked(gateway);
  await sleep(1000 * seconds);
  const built = join(here, 'agents/console/page/built');
  const result = {gateway_cpu_percent: 100 * (worked(gateway) - before) / seconds,
    gateway_mb: Number(/^VmRSS:\s+(\d+)/m.exec(readFileSync(`/proc/${gateway}/status`, 'utf8'))[1]) * 1.024e-3, pages,
    packets: delays.length, packet_to_page_ms_p50: quantile(delays, 0.5), packet_to_page_ms_p99: quantile(delays, 0.99), artifacts: features,
    frames_per_s: intervals.length / seconds, frame_ms_p99: quantile(intervals, 0.99),
    page_kb_gzip: readdirSync(built).reduce((sum, file) => sum + gzipSync(readFileSync(join(built, file)), {level: 9}).length, 0) / 1000,
    first_picture_ms: first};
  console.log(JSON.stringify(result, null, json ? 0 : 2));
} finally {
  await browser?.close();
  for (const child of children) await end(child);
  rmSync(folder, {recursive: true, force: true});
}
process.exit(0);
