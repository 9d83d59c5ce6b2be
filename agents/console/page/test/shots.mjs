// run shots FOLDER [INTO]: pictures of the page, as JPEG, of two simulated robots on the way: telephone upright and across, tablet, desktop, dark, at
// 200 %, two robots, the camera. Says what has to be scrolled to be seen.
import {mkdirSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {chromium} from 'playwright-core';
import {end, freePorts, output, sleep, start, until} from './processes.mjs';

const into = process.argv[2] ?? '.';
mkdirSync(into, {recursive: true});
const phone = {hasTouch: true, isMobile: true, deviceScaleFactor: 2, drives: true};
const shots = [
  {name: 'phone', ...phone, viewport: {width: 390, height: 844}},
  {name: 'phone-across', ...phone, viewport: {width: 844, height: 390}},
  {name: 'tablet', viewport: {width: 820, height: 1180}, hasTouch: true, drives: true},
  {name: 'desktop', viewport: {width: 1280, height: 800}},
  {name: 'dark', viewport: {width: 1280, height: 800}, colorScheme: 'dark', tab: 'Behaviors'},
  {name: 'zoom-200', viewport: {width: 640, height: 400}, deviceScaleFactor: 2},
  {name: 'two-robots', viewport: {width: 1280, height: 800}, robots: true},
  {name: 'link', viewport: {width: 1280, height: 800}, link: true},
  {name: 'camera', viewport: {width: 1280, height: 800}, camera: true, drives: true},
];
const children = [];
let browser;
try {
  const ports = await freePorts(2), names = ['anna', 'bert'];
  for (const [i, name] of names.entries()) {
    children.push(start('saphira', '--robot', name, 'up', 'demo', '--set', `port=${ports[i]}`));
    await until('the address', () => output().includes(`open http://localhost:${ports[i]}/`));
  }
  const address = output().match(new RegExp(`open (http://localhost:${ports[0]}/\\S+)`))[1];
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  for (const name of names) children.push(start('saphira', '--robot', name, 'goal', 'go', 'lobby'));
  let bytes = 0;
  for (const {name, drives, robots, camera, link, tab, ...options} of shots) {
    const page = await (await browser.newContext({reducedMotion: 'reduce', ...options})).newPage();
    page.setDefaultTimeout(30_000);
    await page.goto(address);
    await page.locator('.link.live').waitFor();
    if (drives) await page.getByRole('button', {name: 'Drive', exact: true}).click();
    if (drives) await page.locator('.stick').waitFor();
    if (camera) await page.getByRole('button', {name: 'Camera', exact: true}).click();
    if (robots) await page.getByRole('button', {name: '2 robots'}).click();
    if (link) await page.locator('.link').click();
    if (tab) await page.getByRole('tab', {name: tab}).click();
    await sleep(link ? 20_000 : 3000);
    const file = join(into, `${name}.jpg`);
    await page.screenshot({path: file, type: 'jpeg', quality: 60, scale: options.isMobile ? 'device' : 'css'});
    bytes += statSync(file).size;
    const hidden = await page.evaluate(() => ['header h1', '.estop', '.map canvas', '.stick', '.sentence'].filter(selector => {
      const box = document.querySelector(selector)?.getBoundingClientRect();
      return box && (box.bottom > innerHeight + 1 || box.right > innerWidth + 1 || box.top < -1);
    }));
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    console.log(`${file} ${Math.round(statSync(file).size / 1000)} kB${hidden.length ? `; below the window: ${hidden.join(', ')}` : ''}${wide > 0 ? `; ${wide} pixels too wide` : ''}`);
    if (drives) await page.getByRole('button', {name: 'Hand back'}).click();
    await page.context().close();
  }
  console.log(`${Math.round(bytes / 1000)} kB in all`);
} finally {
  await browser?.close();
  await Promise.all(children.map(end));
}
process.exit(0);
