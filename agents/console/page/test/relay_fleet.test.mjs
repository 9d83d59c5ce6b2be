// Three robots by one relay: the page of one of them, in a real browser, stops each, and then all. What happened is
// read from the simulators' traces.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {chromium} from 'playwright-core';
import {end, ended, freePorts, inTime, output, rig, start, until} from './processes.mjs';

const token = '0123456789abcdef0123456789abcdef';
const folder = mkdtempSync(join(tmpdir(), 'saphira-relays-')), file = name => join(folder, name);
const robots = [], children = [];
let browser;
after(async () => {
  await browser?.close();
  for (const child of [...children, ...robots.flatMap(robot => robot.children ?? [])]) await end(child);
  rmSync(folder, {recursive: true, force: true});
});
const command = (robot, ...words) => {
  const child = start('saphira', '--robot', robot.name, ...words);
  children.push(child);
  return child;
};
const moving = robot => {
  robot.move = command(robot, 'move', '50', '--speed', '0.05');
  return until(`${robot.name} moves`, () => robot.speed() > 0.03);
};
const standing = async (robot, from) => inTime(await until(`${robot.name} stands`, () => robot.stood(from)));

test('the page of one of three robots behind a relay stops each of them, and all', async () => {
  const [dial, ...ports] = await freePorts(4);
  for (const name of ['relay', 'robot'])
    execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
      '-keyout', file(`${name}.key`), '-out', file(`${name}.pem`), '-days', '2', '-subj', '/CN=localhost',
      '-addext', 'subjectAltName=DNS:localhost'], {stdio: 'ignore'});
  writeFileSync(file('robots'), ports.map((port, i) => `robot${i} ${port} ${token}\n`).join(''), {mode: 0o600});
  writeFileSync(file('token'), `${token}\n`, {mode: 0o600});
  children.push(start('saphira-relay', '--robots', file('robots'), '--dial-port', `${dial}`, '--listen', '127.0.0.1',
    '--certificate', file('relay.pem'), '--certificate-key', file('relay.key')));
  await until('the relay', () => output().includes('listens for robots'));
  for (const [i, port] of ports.entries()) {
    const robot = {name: `${['ant', 'bee', 'cow'][i]}-${process.pid}`, page: `https://localhost:${port}/`};
    robots.push(robot);
    await rig(robot, folder, robot.name, {console: ['--certificate', file('robot.pem'), '--certificate-key', file('robot.key'),
      '--dial', `wss://localhost:${dial}/robot${i}`, '--dial-token-file', file('token'), '--dial-authority', file('relay.pem')]});
    await until('its page by the relay', () => output().includes(`open ${robot.page}#`));
  }
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  const page = await browser.newPage({ignoreHTTPSErrors: true});
  page.setDefaultTimeout(30_000);
  await page.goto(`${robots[0].page}#${robots[0].key}`);
  await page.getByRole('button', {name: '3 robots'}).click();
  const row = robot => page.getByRole('region', {name: 'Robots'}).locator('.card', {hasText: robot.name});
  const state = (robot, words) => row(robot).locator('.chip', {hasText: words}).waitFor();
  for (const robot of robots) await state(robot, 'stands');
  for (const robot of robots.slice(1))
    assert.equal(await row(robot).getByRole('link', {name: robot.name}).getAttribute('href'), robot.page);

  for (const robot of robots) await moving(robot);
  const order = [...robots.slice(1), robots[0]];
  for (const [i, robot] of order.entries()) {
    const from = robot.now();
    await row(robot).getByRole('button', {name: `Stop ${robot.name}`}).click();
    await standing(robot, from);
    await state(robot, 'emergency stop');
    for (const other of order.slice(i + 1)) assert.ok(other.speed() > 0.03, `${other.name}: ${other.speed()} m/s`);
  }

  for (const robot of robots) {
    await end(robot.move);
    await ended(command(robot, 'estop', 'reset'));
    await ended(command(robot, 'drive', 'hand-back'));
    await moving(robot);
  }
  const from = robots.map(robot => robot.now());
  await page.getByRole('button', {name: 'STOP ALL'}).click();
  for (const [i, robot] of robots.entries()) await standing(robot, from[i]);
  for (const robot of robots) await state(robot, 'emergency stop');
});
