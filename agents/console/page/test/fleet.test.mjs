// Two robots at one page: both are listed, one is stopped, then both; and the way to the other one's page.
import assert from 'node:assert/strict';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {chromium} from 'playwright-core';
import {end, rig, start, until} from './processes.mjs';

const folder = mkdtempSync(join(tmpdir(), 'saphira-fleet-')), rigs = [], more = [];
let browser;
after(async () => {
  await browser?.close();
  for (const child of [...more, ...rigs.flatMap(({children}) => children)]) await end(child);
  rmSync(folder, {recursive: true, force: true});
});
const moving = robot => {
  more.push(start('saphira', '--robot', robot.name, 'move', '50', '--speed', '0.05'));
  return until(`${robot.name} moves`, () => robot.speed() > 0.03);
};
const standing = robot => until(`${robot.name} stands`, () => robot.stood(robot.now() - 2) !== undefined);

test('two robots are listed, one is stopped alone, then both', async () => {
  for (const name of ['ant', 'bee']) {
    const robot = {name: `${name}-${process.pid}`};
    rigs.push(robot);
    await rig(robot, folder, robot.name);
  }
  const [ant, bee] = rigs;
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  const page = await browser.newPage();
  page.setDefaultTimeout(30_000);
  const row = robot => page.getByRole('region', {name: 'Robots'}).locator('.card', {hasText: robot.name});
  const state = (robot, words) => row(robot).locator('.chip', {hasText: words}).waitFor();
  const list = async () => {
    await page.getByRole('button', {name: '2 robots'}).click();
    await state(ant, 'stands');
    await state(bee, 'stands');
  };

  // Who only watches ends the motion of one, and the other goes on.
  await page.goto(`http://localhost:${ant.port}/`);
  await list();
  await row(ant).getByText('this page').waitFor();
  for (const robot of rigs) await moving(robot);
  for (const robot of rigs) await state(robot, 'drives');
  await row(bee).getByText('a program drives').waitFor();
  await row(bee).getByRole('button', {name: `Stop ${bee.name}`}).click();
  await standing(bee);
  await state(bee, 'stands');
  assert.ok(ant.speed() > 0.03, `${ant.name}: ${ant.speed()} m/s`);
  await page.getByRole('button', {name: 'STOP ALL'}).click();
  await standing(ant);
  await state(ant, 'stands');

  // With the key it is the emergency stop, until Reset at each one's page.
  await page.goto(`http://localhost:${ant.port}/#${ant.key}`);
  await page.reload();
  await list();
  await moving(bee);
  await row(bee).getByRole('button', {name: `Stop ${bee.name}`}).click();
  await state(bee, 'emergency stop');
  await standing(bee);
  await moving(ant);
  await state(ant, 'drives');
  await page.getByRole('button', {name: 'STOP ALL'}).click();
  await state(ant, 'emergency stop');
  await standing(ant);
  await row(bee).getByRole('link', {name: bee.name}).click();
  await page.waitForURL(`http://localhost:${bee.port}/`);
  await page.getByRole('heading', {name: bee.name}).waitFor();
  await page.getByText('pressed by somebody at the console').waitFor();

  // A robot that is gone leaves the list.
  await page.getByRole('button', {name: '2 robots'}).click();
  await end(ant.children[1]);
  await state(ant, 'not heard');
  await end(ant.children[0]);
  await row(ant).waitFor({state: 'detached'});
});
