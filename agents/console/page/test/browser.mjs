// A simulated robot with all that drives it, and people at its page in Chromium.
import assert from 'node:assert/strict';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before} from 'node:test';
import {chromium} from 'playwright-core';
import {end, output, start, until} from './processes.mjs';

const limit = 30_000;        // [ms] generous: for broken runs
export const folder = mkdtempSync(join(tmpdir(), 'saphira-console-'));
export let up, address, machine;  // machine: all processes of the browser
let browser;

export const robot = `console-${process.pid}`;

before(async () => {
  // Ports of its own: a restarted gateway finds its port again, whatever runs beside it.
  const port = 20_000 + process.pid % 500 * 20;
  up = start('saphira', '--robot', robot, 'up', 'demo', '--set', `behaviors=${folder}`, '--set', `port=${port}`,
    '--set', 'approval=saphira goal');
  address = await until('the address', () => output().match(/open (http:\S+)/)?.[1]);
  machine = await chromium.launchServer({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
  browser = await chromium.connect(machine.wsEndpoint());
});
after(async () => {
  await browser?.close();
  await machine?.close();
  await end(up);
  rmSync(folder, {recursive: true, force: true});
});

// A browser profile of its own: another person. Complaints of the page are failures.
export async function person(options = {}) {
  // Chromium draws by software here: without motion between two samples it leaves the processors to the robot.
  const context = await browser.newContext({viewport: {width: 1280, height: 800}, reducedMotion: 'reduce', ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(limit);
  page.complaints = [];
  page.on('pageerror', error => page.complaints.push(String(error)));
  page.on('console', message => {
    if (message.type() === 'error' && !/WebSocket connection/.test(message.text())) page.complaints.push(message.text());
  });
  return page;
}
export async function open(page, withKey = true) {
  await page.goto(withKey ? address : address.replace(/#.*/, ''));
  await page.locator('.link.live').waitFor();
}
export async function leave(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}
export const fact = async (page, name) => page.locator(`dl div:has(dt:text-is("${name}")) dd`).innerText();
export const speed = async page => parseFloat(await fact(page, 'Speed'));
export const moves = page => until('the robot moves', async () => await speed(page) > 0.04);
export const stands = page => until('the robot stands', async () => Math.abs(await speed(page)) < 0.02);
export const send = async (page, words) => {
  await page.getByLabel('Ask the robot for something').fill(words);
  await page.getByRole('button', {name: 'Send'}).click();
};
