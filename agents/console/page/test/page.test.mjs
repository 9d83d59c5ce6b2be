// The page as people use it, in Chromium, before a simulated robot with all that drives it.
import assert from 'node:assert/strict';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import net from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {chromium} from 'playwright-core';
import {end, output, sleep, start, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

const axeSource = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const limit = 30_000;        // [ms] generous: for broken runs
const folder = mkdtempSync(join(tmpdir(), 'saphira-console-'));
let up, address, machine, browser;  // machine: all processes of the browser

const bin = process.env.SAPHIRA_BIN_DIR;
const robot = `console-${process.pid}`;

before(async () => {
  // Ports of its own: a restarted gateway finds its port again, whatever runs beside it.
  const port = 20_000 + process.pid % 500 * 20;
  up = start('saphira', '--robot', robot, 'up', 'demo', '--set', `behaviors=${folder}`, '--set', `port=${port}`);
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
async function person(options = {}) {
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
async function open(page, withKey = true) {
  await page.goto(withKey ? address : address.replace(/#.*/, ''));
  await page.locator('.link.live').waitFor();
}
async function leave(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}
const fact = async (page, name) => page.locator(`dl div:has(dt:text-is("${name}")) dd`).innerText();
const speed = async page => parseFloat(await fact(page, 'Speed'));
const moves = page => until('the robot moves', async () => await speed(page) > 0.04);
const stands = page => until('the robot stands', async () => Math.abs(await speed(page)) < 0.02);
async function takeControl(page, name) {
  await page.getByLabel('I am').fill(name);
  await page.getByLabel('I am').blur();
  await until('control', async () => {
    if (await page.getByText('You drive').count()) return true;
    const button = page.getByRole('button', {name: 'Drive', exact: true});
    if (await button.count()) await button.click({timeout: 1000}).catch(() => {});
    await page.waitForTimeout(300);
    return false;
  });
}
// Holds something until the robot moves. A busy machine breaks the chain of samples now and then, and then
// the robot rightly waits until it is let go, or control is gone: again.
async function drive(page, hold, letGo, forward) {
  await until('the robot moves', async () => {
    const button = page.getByRole('button', {name: 'Drive', exact: true});
    if (await button.count()) await button.click({timeout: 1000}).catch(() => {});
    await hold();
    const end = Date.now() + 3000;
    while (Date.now() < end) {
      if ((forward ? 1 : -1) * await speed(page) > 0.04) return true;
      await page.waitForTimeout(50);
    }
    await letGo();
    await page.waitForTimeout(300);
    return false;
  });
}
const driveByKey = (page, key, forward) => drive(page, () => page.keyboard.down(key), () => page.keyboard.up(key), forward);
async function handBack(page) {
  await page.getByRole('button', {name: 'Hand back'}).click();
  await until('autonomy may drive', async () => !(await page.getByText('autonomy waits').count()));
}
const send = async (page, words) => {
  await page.getByLabel('Ask the robot for something').fill(words);
  await page.getByRole('button', {name: 'Send'}).click();
};
const openGoals = page => page.getByRole('list', {name: 'Goals', exact: true}).locator('.card');
const endedGoals = page => page.getByRole('list', {name: 'Ended goals'}).locator('.card');
async function endAll(page) {
  await page.getByRole('button', {name: 'End all'}).click();
  await until('the end of every goal', async () => await openGoals(page).count() === 0);
}
// A place right of the robot.
async function choosePlace(page) {
  const box = await page.locator('canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 60, box.y + box.height / 2);
  await page.getByRole('dialog').waitFor();
}
// How many pixels of the picture each color has.
async function colorsOf(page) {
  return new Map(await page.evaluate(() => {
    const canvas = document.querySelector('canvas'), count = new Map();
    for (const color of new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer))
      count.set(color, (count.get(color) ?? 0) + 1);
    const [r, g, b] = [0, 8, 16].map(shift => color => (color >> shift & 255).toString(16).padStart(2, '0'));
    return [...count].map(([color, pixels]) => [`#${r(color)}${g(color)}${b(color)}`, pixels]);
  }));
}
// From now on the page hears these topics with other members, and so much older [ms]; of a cycle: by so many later.
const hears = (page, topics, age = 0) => page.evaluate(([topics, age]) => {
  const get = saphira.get.bind(saphira);
  saphira.get = (topic, key) => {
    const item = get(topic, key), {cycle = 0, ...members} = topics[topic] ?? {};
    if (!item || !topics[topic]) return item;
    return {at: item.at - age, data: {...item.data, ...members, ...(cycle && {cycle: item.data.cycle + cycle})}};
  };
}, [topics, age]);
const childrenOf = pid => readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8').trim().split(' ').filter(child => child);
const familyOf = pid => [pid, ...childrenOf(pid).flatMap(familyOf)];
async function gatewayProcess() {
  return until('the console process', async () => {
    for (const pid of childrenOf(up.pid))
      if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').startsWith(join(bin, 'saphira-console') + '\0')) return Number(pid);
    return undefined;
  });
}

test('shows the robot, on a map, soon', async () => {
  const page = await person();
  await open(page);
  assert.equal(new URL(page.url()).hash, '', 'the key does not stay in the address');
  await until('the place on the map', async () => page.locator('dt:text-is("On the map")').count());
  assert.match(await fact(page, 'Battery'), /^\d+\.\d V$/);
  assert.match(await fact(page, 'On the map'), /m, \d+° ± .* c?m, \d+% sure$/);
  const colors = await colorsOf(page), robotColor = '#1a5fb4';
  assert.ok(colors.size > 5, `${colors.size} colors are on the canvas`);
  assert.ok(colors.get(robotColor) > 20, `${colors.get(robotColor)} pixels of the robot`);
  // A lost robot is drawn, and told, as a guess.
  await hears(page, {registration: {state: 'REGISTRATION_LOST', confidence: 0, reason: 'nothing fits'}});
  await page.getByText('The robot does not know where it is (nothing fits). Click where it is on the map').waitFor();
  assert.match(await fact(page, 'Lost, at a guess'), / m, \d+°, 0% sure$/);
  await until('a robot that is not filled', async () => !(await colorsOf(page)).has(robotColor));
  await leave(page);
});

test('old news are told with their age', async () => {
  const page = await person();
  await open(page);
  await send(page, 'drive 0.05');
  const card = openGoals(page).first();
  await card.getByText('underway').waitFor();
  assert.doesNotMatch(await page.locator('.sentence').innerText(), / ago: /);
  assert.equal(await card.getByText(/ ago$/).count(), 0);
  await hears(page, {'goals/status': {}, why: {cycle: -50}}, 5000);
  await card.getByText(/^[5-7]\.\d s ago$/).waitFor();
  await page.locator('.sentence').getByText(/^[5-7]\.\d s ago: /).waitFor();
  await endAll(page);
  await leave(page);
});

for (const [name, options] of [['light', {colorScheme: 'light'}], ['dark', {colorScheme: 'dark'}],
                               ['a telephone', {viewport: {width: 320, height: 640}, hasTouch: true, isMobile: true}]])
  test(`axe finds nothing, and nothing is cut off: ${name}`, async () => {
    const page = await person({...options, bypassCSP: true});
    await open(page);
    await page.addScriptTag({content: axeSource});
    for (const tab of ['Goals', 'Why', 'Behaviors', 'Intentions', 'Programs', 'Messages']) {
      await page.getByRole('tab', {name: tab}).click();
      // The dark page has other colors, and else nothing of its own.
      const {violations} = await page.evaluate(dark => window.axe.run(dark ? {runOnly: ['color-contrast']} : {}), name === 'dark');
      assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), [], tab);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${tab} is wider than the window`);
    }
    if (options.isMobile) await page.getByText('Layers').click();
    await page.getByRole('link', {name: "the simulator's own view"}).waitFor();
    await leave(page);
  });

test('the legend opens and closes by mouse and by keyboard, and lists what is drawn', async () => {
  for (const options of [{}, {viewport: {width: 320, height: 640}, hasTouch: true, isMobile: true}]) {
    const page = await person({...options, bypassCSP: true});
    await open(page);
    const button = page.getByRole('button', {name: 'Legend'}), legend = page.getByRole('region', {name: 'Legend'});
    assert.equal(await button.getAttribute('aria-expanded'), 'false');
    assert.equal(await legend.count(), 0);
    await button.click();
    assert.equal(await button.getAttribute('aria-expanded'), 'true');
    for (const words of ['the robot and its nose', 'lost: the robot at a guess', 'the route', 'a goal', 'a sonar echo; larger: a new one', 'a person; with an arm: who points', 'a door that was closed', 'a zone to keep out of'])
      await legend.getByText(words, {exact: true}).waitFor();
    // Each line has its sign, in a colour of the map.
    assert.equal(await legend.locator('li').count(), await legend.locator('li svg > *').count());
    assert.ok(await legend.locator('li').count() >= 25);
    await page.addScriptTag({content: axeSource});
    const {violations} = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await legend.focus();
    await page.keyboard.press('Escape');
    assert.equal(await legend.count(), 0);
    assert.ok(await button.evaluate(b => b === document.activeElement));
    await page.keyboard.press('Enter');
    await legend.waitFor();
    await page.keyboard.press('Escape');
    await until('it is closed', async () => await legend.count() === 0);
    // It covers none of the other buttons.
    const [box, layers] = [await button.boundingBox(), await page.locator('.layers').boundingBox()];
    assert.ok(box.x + box.width <= layers.x || box.y + box.height <= layers.y, JSON.stringify([box, layers]));
    await leave(page);
  }
});

test('a click sends the robot, with an answer and a cancel button', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  const box = await page.locator('canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 90, box.y + box.height / 2);
  await page.getByRole('button', {name: 'Go here'}).click();
  const card = page.locator('.card:not(.over)', {hasText: 'go to'});
  await card.locator('.chip', {hasText: 'underway'}).waitFor();
  await moves(page);
  await card.getByRole('button', {name: 'Cancel'}).click();
  await page.locator('.card.over', {hasText: 'go to'}).waitFor();
  await stands(page);
  // A refused goal shows the reason: words that are no goal at once, and a place that the map does not have in its card.
  await send(page, 'go 3 nowhere');
  await page.locator('.told.bad').waitFor();
  await send(page, 'go nowhere at all');
  await endedGoals(page).filter({hasText: 'the map has no place "nowhere at all"'}).first().waitFor();
  await leave(page);
});

test('says what can be asked for', async () => {
  const page = await person();
  await open(page);
  for (const words of ['go N1', 'go corridor', 'go_to position=', 'patrol'])
    await page.locator(`#goal-wishes option[value="${words}"]`).waitFor({state: 'attached'});
  assert.equal(await page.getByLabel('Ask the robot for something').getAttribute('placeholder'), 'go lobby, turn to 90');
  await leave(page);
});

test('a place is chosen without a mouse, and left', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  await page.locator('canvas').focus();
  const dialog = page.getByRole('dialog', {name: 'A place on the map'});
  const choose = async () => { for (let i = 0; i < 4; ++i) await page.keyboard.press('Shift+ArrowRight'); };
  await choose();
  await dialog.waitFor();
  await page.keyboard.press('Enter');
  await page.keyboard.press('Escape');
  await dialog.waitFor({state: 'detached'});
  await choose();   // the picture has the keys again
  await page.keyboard.press('Enter');
  await page.keyboard.press('Enter');
  await openGoals(page).filter({hasText: 'go to'}).getByText('underway').waitFor();
  await moves(page);
  await endAll(page);
  await stands(page);
  await leave(page);
});

test('goals wait in their order, one goes instead of them, and an ended one is asked for again', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  await send(page, 'drive 0.05');
  const [first, second, third] = [0, 1, 2].map(i => openGoals(page).nth(i));
  await first.filter({hasText: 'drive'}).getByText('underway').waitFor();
  await send(page, 'turn to 90');
  await first.filter({hasText: '1. drive'}).getByText('in front').waitFor();
  await second.filter({hasText: '2. turn to'}).getByText('next').waitFor();
  await second.getByText('waits for "drive"').waitFor();
  await choosePlace(page);
  await page.getByText('1 more waits').waitFor();
  await page.getByRole('button', {name: 'Go here after that'}).click();
  await third.filter({hasText: '3. go to'}).getByText('waiting').waitFor();
  await choosePlace(page);
  await page.getByText('2 more wait').waitFor();
  await page.getByRole('button', {name: 'Go here instead'}).click();
  await first.filter({hasText: 'go to'}).getByText('underway').waitFor();
  for (const ended of ['drive', 'turn to', 'go to']) await endedGoals(page).filter({hasText: ended}).getByText('canceled').first().waitFor();
  await endAll(page);
  await page.getByRole('button', {name: 'Ask again: go to'}).first().click();
  await first.filter({hasText: 'go to'}).getByText('underway').waitFor();
  await endAll(page);
  await leave(page);
});

test('the card of a place does not cover it, and sets the position of the robot after a question only', async () => {
  for (const options of [{}, {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true}]) {
    const page = await person(options);
    await open(page);
    await page.locator('dt:text-is("On the map")').waitFor();
    const card = page.getByRole('dialog'), canvas = await page.locator('canvas').boundingBox();
    for (const x of [0.05, 0.5, 0.95])
      for (const y of [0.2, 0.5, 0.95]) {
        const at = {x: canvas.x + x * canvas.width, y: canvas.y + y * canvas.height};
        await page.mouse.click(at.x, at.y);
        await until(`the card beside ${x}, ${y}`, async () => {
          const box = await card.boundingBox();
          return box && (at.x < box.x || at.x > box.x + box.width || at.y < box.y || at.y > box.y + box.height);
        });
        await card.getByRole('button', {name: 'Close'}).click();
      }
    await leave(page);
  }
  const page = await person();
  await open(page);
  await page.locator('dt:text-is("On the map")').waitFor();
  await page.getByRole('button', {name: 'Follow'}).click();
  const canvas = await page.locator('canvas').boundingBox();
  await page.mouse.click(canvas.x + canvas.width / 2, canvas.y + canvas.height / 2);  // where the robot is
  const question = page.getByText("Set the robot's position here?"), yes = page.getByRole('button', {name: 'Yes', exact: true});
  assert.equal(await yes.count(), 0);
  await page.getByRole('button', {name: 'The robot is here'}).click();
  await question.waitFor();
  await page.getByRole('button', {name: 'No', exact: true}).click();
  await question.waitFor({state: 'detached'});
  await page.getByRole('button', {name: 'The robot is here'}).click();
  await yes.click();
  await page.getByRole('dialog').waitFor({state: 'detached'});
  await leave(page);
});

test('keys drive while they are held, and somebody else waits for control', async () => {
  const ann = await person(), bob = await person();
  await open(ann);
  await takeControl(ann, 'ann');
  await driveByKey(ann, 'i', true);
  await ann.keyboard.up('i');
  await stands(ann);
  await open(bob);
  await bob.getByText('ann has control').waitFor();
  await bob.getByRole('button', {name: 'Ask for it'}).click();
  await ann.getByText('asks for control').waitFor();
  await ann.getByRole('button', {name: 'Give it'}).click();
  await bob.getByText('You drive').waitFor();
  await ann.getByRole('button', {name: 'Take it'}).click();
  await driveByKey(ann, 'i', true);
  await bob.getByRole('button', {name: 'Take it'}).click();
  await bob.getByText('You drive').waitFor();
  await stands(bob);  // though ann still holds the key
  await ann.getByText('has control').waitFor();
  await ann.keyboard.up('i');
  await handBack(bob);
  await leave(ann);
  await leave(bob);
});

test('k stops a robot that drives by itself', async () => {
  const page = await person();
  await open(page);
  await send(page, 'drive 0.2');
  await moves(page);
  await takeControl(page, 'ann');
  await page.getByText('it drives by itself until you hold something').waitFor();
  await until('the robot stands', async () => {
    await page.keyboard.press('k');
    await page.waitForTimeout(300);
    return Math.abs(await speed(page)) < 0.02;
  });
  await page.getByRole('button', {name: 'End all'}).click();
  await handBack(page);
  await leave(page);
});

test('the stick drives, and letting it go or losing the window stops', async () => {
  const page = await person();
  await open(page);
  await takeControl(page, 'ann');
  const box = await page.locator('svg.stick').boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const back = () => drive(page, async () => {
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0], middle[1] + 40);
  }, () => page.mouse.up(), false);
  await back();
  await page.mouse.up();
  await stands(page);
  await back();
  await page.evaluate(() => dispatchEvent(new Event('blur')));
  await stands(page);
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();  // it only watches now
  await page.mouse.up();
  await handBack(page);
  await leave(page);
});

test('a gamepad drives with a shoulder button, one that is unplugged stops, and another takes over after that', async () => {
  const page = await person();
  await page.addInitScript(() => {
    const pad = (index, id) => ({index, id, connected: true, axes: [0, 0], buttons: Array.from({length: 16}, () => ({pressed: false}))});
    window.pads = [null, pad(1, 'Test pad (Vendor: 1)'), pad(2, 'Other pad (Vendor: 2)')];
    window.shown = [];  // a browser hides gamepads until one of their buttons was pressed
    navigator.getGamepads = () => window.shown;
  });
  await open(page);
  await takeControl(page, 'ann');
  await page.getByText('A gamepad shows once one of its buttons is pressed').waitFor();
  await page.evaluate(() => { window.shown = window.pads; });
  await page.getByText('hold a shoulder button').waitFor();
  const shoulder = (pad, pressed) => page.evaluate(([n, is]) => { window.pads[n].buttons[4].pressed = is; }, [pad, pressed]);
  await page.evaluate(() => { window.pads[1].axes[1] = window.pads[2].axes[1] = 1; });  // drift: move nothing
  await drive(page, () => shoulder(2, true), () => shoulder(2, false), false);
  // While one is held the other moves nothing, also after the first is gone.
  await page.getByText('Gamepad Other pad.').waitFor();
  await shoulder(1, true);
  await page.evaluate(() => {
    window.pads[2] = null;
    dispatchEvent(new Event('gamepaddisconnected'));
  });
  await stands(page);
  await page.getByText('let go of all gamepads first').waitFor();
  await shoulder(1, false);
  await page.getByText('Gamepad Test pad: hold a shoulder button').waitFor();
  await handBack(page);
  await leave(page);
});

test('everybody may stop the robot, also without the key', async () => {
  const ann = await person(), guest = await person();
  await open(ann);
  await open(guest, false);
  await guest.getByText('You watch').waitFor();
  assert.equal(await guest.getByRole('button', {name: 'Drive', exact: true}).count(), 0);
  assert.ok(await guest.getByRole('button', {name: 'Send'}).isDisabled());
  await guest.getByRole('button', {name: 'Emergency stop'}).click();
  for (const page of [ann, guest]) await page.getByRole('alert').filter({hasText: 'pressed by'}).waitFor();
  assert.ok(await guest.getByRole('button', {name: 'Reset'}).isDisabled());
  const reset = async () => {
    await ann.getByRole('button', {name: 'Reset'}).click();
    await until('the reset', async () => !(await ann.getByRole('alert').count()));
  };
  await reset();
  // The keys of the stop, too: of a guest, and of somebody who has no control.
  await guest.locator('canvas').focus();
  await guest.keyboard.press(' ');
  await guest.getByText('Emergency stop by the key space').waitFor();
  await ann.getByRole('alert').filter({hasText: 'pressed by'}).waitFor();
  await reset();
  await ann.keyboard.press('k');
  await guest.getByRole('alert').filter({hasText: 'pressed by'}).waitFor();
  await reset();
  if (await ann.getByRole('button', {name: 'Hand back'}).count()) await handBack(ann);
  await leave(ann);
  await leave(guest);
});

test('a gateway that hangs is told, the robot stands, and afterwards the page only watches', async () => {
  const page = await person(), watcher = await person();
  await open(page);
  await takeControl(page, 'ann');
  await driveByKey(page, 'm', false);
  let pid = await gatewayProcess();
  // Shortly: the words name the reason, and what is held. A busy machine makes the gap longer, and then: again.
  const words = 'The picture came too late, so the robot stopped: let go of the key, then press it again.';
  await until('the reason', async () => {
    pid = await gatewayProcess();
    process.kill(pid, 'SIGSTOP');
    await sleep(600);
    process.kill(pid, 'SIGCONT');
    const told = await Promise.all(['.drive', '.sentence'].map(place => page.locator(place, {hasText: words}).waitFor({timeout: 1500}))).then(() => true, () => false);
    await page.keyboard.up('m');
    await driveByKey(page, 'm', false);
    return told;
  });
  process.kill(pid, 'SIGSTOP');
  try {
    await page.locator('.link.gone').waitFor();
    await page.locator('canvas.stale').waitFor();
    await page.getByText('nothing from here reaches the robot').waitFor();
    assert.ok(await page.getByRole('button', {name: 'Release'}).isDisabled());
    assert.ok(await page.getByRole('button', {name: 'Hand back'}).isDisabled());
  } finally {
    try {
      process.kill(pid, 'SIGCONT');
    } catch {
      // The supervisor has found that it hangs, and started another one: the page may find either.
    }
  }
  await page.locator('.link.live').waitFor();
  await page.getByText('You have lost control').waitFor();
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();
  await stands(page);  // the key is still held
  await page.keyboard.up('m');
  await open(watcher);
  await handBack(page);
  await leave(page);
  await leave(watcher);
});

// Somebody else's look at the robot, beside the browser.
async function watch() {
  const {host, port, hash} = new URL(address), headers = {Host: host, Origin: `http://${host}`};
  const self = await socketTo(Number(port), 'saphira.telemetry', headers);
  self.say({type: 'hello', key: hash.slice(1), name: 'watcher'});
  self.speed = () => {
    for (const frame of self.texts.splice(0)) {
      for (const {t, d} of frame.items ?? []) if (t === 'robot/state') self.velocity = d.velocity;
      if (frame.seq !== undefined) self.say({type: 'ack', frame: frame.seq});
    }
    return Math.abs(self.velocity);
  };
  return self;
}

test('a laptop that sleeps: the robot stands, and afterwards the page only watches', async () => {
  const page = await person(), watcher = await watch();
  await open(page);
  await takeControl(page, 'ann');
  await driveByKey(page, 'i', true);
  await until('the robot moves', () => watcher.speed() > 0.04);
  const asleep = familyOf(machine.process().pid);
  for (const pid of asleep) process.kill(pid, 'SIGSTOP');
  try {
    await until('the robot stands', () => watcher.speed() < 0.02);
    await sleep(1500);
    assert.ok(watcher.speed() < 0.02);
  } finally {
    for (const pid of asleep) process.kill(pid, 'SIGCONT');
  }
  await page.locator('.link.live').waitFor();
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();
  await stands(page);  // the key is held all the time
  await page.keyboard.up('i');
  await handBack(page);
  watcher.socket.destroy();
  await leave(page);
});

test('a behavior that is edited while it runs is seen; a broken version changes nothing and says where', async () => {
  const shipped = readFileSync(join(process.env.SAPHIRA_SOURCE_DIR, 'config/behaviors/constant-velocity.beh'), 'utf8');
  const edit = text => writeFileSync(join(folder, 'constant-velocity.beh'), text);
  const page = await person();
  await open(page);
  await send(page, 'drive 0.05');
  await page.getByRole('tab', {name: 'Behaviors'}).click();
  await page.getByRole('button', {name: 'ConstantVelocity'}).click();
  const rule = name => page.locator('.rule', {hasText: name}).waitFor();
  await rule('go');
  edit(shipped.replace('go If', 'creep If'));
  await rule('creep');
  edit(shipped.replace('go If', 'go Iff'));
  await page.getByRole('tab', {name: 'Messages'}).click();
  await page.getByLabel('everything that programs log').check();
  await page.locator('.lines li', {hasText: 'constant-velocity.beh:7:'}).first().waitFor();
  await page.getByRole('tab', {name: 'Behaviors'}).click();
  await page.getByRole('button', {name: 'ConstantVelocity'}).click();
  await rule('creep');
  rmSync(join(folder, 'constant-velocity.beh'));
  await rule('go');
  await page.getByRole('tab', {name: 'Goals'}).click();
  await endAll(page);
  await leave(page);
});

test('a micro-task is held and let go on; drawings and messages of a program, and what a person says, are shown', async t => {
  const page = await person();
  await open(page);
  const magenta = async () => (await colorsOf(page)).get('#ff00ff') ?? 0;
  const drawing = {source: 'test', frame: 'FRAME_ROBOT', shape: 'DRAWING_LINE', points: [{x: 0.5, y: -0.5}, {x: 0.5, y: 0.5}],
    red: 255, blue: 255, width: 0.2};
  const draws = start('saphira', '--robot', robot, 'write', 'drawings', JSON.stringify(drawing));
  const tells = start('saphira', '--robot', robot, 'write', 'messages', '-');
  t.after(() => [draws, tells].map(end));
  await until('the drawing', magenta);
  await page.getByText('Layers').click();
  await page.getByLabel('drawings of programs').uncheck();
  await until('no drawing', async () => await magenta() === 0);
  await page.getByLabel('drawings of programs').check();
  await until('the drawing again', magenta);
  await end(draws);
  await until('its end', async () => await magenta() === 0);

  await page.getByRole('tab', {name: 'Messages'}).click();
  await page.getByLabel('Say something to the robot').fill('good morning');
  await page.getByRole('button', {name: 'Say'}).click();
  await page.locator('.lines li', {hasText: 'good morning'}).first().waitFor();
  // Until it is heard: the console may not have found the writer yet.
  await until('the message', async () => {
    tells.stdin.write('{"source":"test","text":"dinner is ready"}\n');
    await sleep(100);
    return page.locator('.lines li', {hasText: 'test dinner is ready'}).count();
  });

  await page.getByRole('tab', {name: 'Programs'}).click();
  await page.locator('summary', {hasText: 'interpretation'}).click();
  const task = page.locator('.processes li', {hasText: 'occgrid'});
  await task.getByRole('button', {name: 'Interrupt occgrid'}).click();
  await task.locator('.chip', {hasText: 'suspended'}).waitFor();
  await task.getByRole('button', {name: 'Resume occgrid'}).click();
  await task.locator('.chip', {hasText: 'running'}).waitFor();
  await leave(page);
});

test('reload and the back button keep the key', async () => {
  const page = await person();
  await open(page);
  await page.reload();
  await page.locator('.link.live').waitFor();
  await page.goto('about:blank');
  await page.goBack();
  await page.locator('.link.live').waitFor();
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();
  await leave(page);
});

// A link between page and gateway that delays, and that can be cut: what is sent meanwhile comes afterwards.
async function link() {
  const state = {delay: 0, cut: false};
  const carry = (from, to) => {
    let last = Promise.resolve();
    from.on('data', data => {
      const due = Date.now() + state.delay;
      last = last.then(async () => {
        while (Date.now() < due || state.cut) await sleep(5);
        if (!to.destroyed) to.write(data);
      });
    });
    from.on('close', () => last.then(() => to.destroy())).on('error', () => {});
  };
  const gateway = Number(new URL(address).port);
  const server = net.createServer(near => {
    const far = net.connect(gateway, '127.0.0.1');
    carry(near, far);
    carry(far, near);
  });
  server.unref();  // a failed test does not keep the program
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
  state.address = address.replace(/:\d+\//, `:${server.address().port}/`);
  return state;
}

test('over a slow link it drives and says so; a cut link stops the robot and comes back to watching', async () => {
  const far = await link(), page = await person(), watcher = await person();
  await open(watcher);
  far.delay = 200;
  await page.goto(far.address);
  await page.locator('.link.live').waitFor();
  await takeControl(page, 'ann');
  await driveByKey(page, 'm', false);
  await page.getByText('there and back: the robot is slowed down').waitFor();
  far.cut = true;
  await page.locator('.link.gone').waitFor();
  await stands(watcher);
  await watcher.getByRole('button', {name: 'Drive', exact: true}).waitFor();  // control is free
  far.cut = false;
  await page.locator('.link.live').waitFor();
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();
  await stands(page);  // the key is held all the time
  await page.keyboard.up('m');
  await handBack(watcher);
  await leave(page);
  await leave(watcher);
});

// Last: it loads another world.
test('the simulator is paused, stepped, rearranged and given another world, and the robot is not told', async () => {
  const page = await person(), stranger = await person(), watcher = await person();
  await open(watcher);
  await page.goto(address.replace('/#', '/simulator.html#'));
  const at = async () => (await page.getByText(/^x .* m, y .* m/).innerText()).match(/x (\S+) m, y (\S+) m/).slice(1).map(Number);
  await page.locator('.chip.good', {hasText: 'runs'}).waitFor();
  const looked = await person({bypassCSP: true});
  await looked.goto(address.replace('/#', '/simulator.html#'));
  await looked.locator('.chip.good', {hasText: 'runs'}).waitFor();
  await looked.addScriptTag({content: axeSource});
  const {violations} = await looked.evaluate(() => window.axe.run());
  await leave(looked);
  assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), []);

  await page.getByRole('button', {name: 'Pause'}).click();
  await page.locator('.chip', {hasText: 'paused'}).waitFor();
  // A robot that says nothing: the picture of it is marked as old.
  await watcher.locator('.link.old').waitFor();
  await watcher.locator('canvas.stale').waitFor();
  await watcher.getByText('The robot says nothing.').waitFor();
  const time = async () => parseFloat(await fact(page, 'Time'));
  const before = await time();
  await page.getByRole('button', {name: 'Step 0.1 s'}).click();
  await until('a step', async () => Math.abs(await time() - before - 0.1) < 0.01);
  await page.getByRole('button', {name: 'Go on'}).click();
  await until('time', async () => await time() > before + 0.5);

  const [x, y] = await at();
  await page.getByRole('button', {name: 'Move it right'}).click();
  await until('the robot is moved', async () => Math.abs((await at())[0] - x - 0.1) < 0.02);
  // By hand: it is picked up where it is drawn, and put down elsewhere.
  const canvas = await page.locator('canvas').boundingBox();
  const scale = 0.95 * Math.min(canvas.width / 24, canvas.height / 14);
  const pixel = (wx, wy) => [canvas.x + (canvas.width - 24 * scale) / 2 + wx * scale, canvas.y + (canvas.height + 14 * scale) / 2 - wy * scale];
  await page.mouse.move(...pixel(x + 0.1, y));
  await page.mouse.down();
  await page.mouse.move(...pixel(x + 1, y), {steps: 5});
  await page.mouse.up();
  await until('the robot is carried', async () => Math.abs((await at())[0] - x - 1) < 0.15);
  // The picture: a pixel's colour tells where the robot is drawn.
  const drawnAt = (px, py) => page.evaluate(([px, py]) => {
    const canvas = document.querySelector('canvas'), ratio = canvas.width / canvas.clientWidth;
    const [r, g, b] = canvas.getContext('2d').getImageData((px - canvas.getBoundingClientRect().x) * ratio, (py - canvas.getBoundingClientRect().y) * ratio, 1, 1).data;
    return `#${[r, g, b].map(c => c.toString(16).padStart(2, '0')).join('')}`;
  }, [px, py]);
  const robotColor = await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--map-robot').trim());
  const middle = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  // Beside the line of its heading.
  const inTheMiddle = async () => [await drawnAt(middle[0] + 4, middle[1] + 4), await drawnAt(middle[0] - 4, middle[1] - 4), await drawnAt(middle[0] + 4, middle[1] - 4)].includes(robotColor);
  await page.locator('canvas').focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press('+');
  assert.equal(await inTheMiddle(), false);
  await page.getByRole('button', {name: 'Recenter'}).click();
  await until('the robot in the middle', inTheMiddle);
  await page.getByRole('button', {name: 'Follow'}).click();
  await page.getByRole('button', {name: 'Follow', pressed: true}).waitFor();
  await page.mouse.click(middle[0] + canvas.width / 2 - 5, middle[1], {button: 'middle'});   // the robot is at the other edge
  await until('the picture follows the robot', inTheMiddle);
  await page.getByRole('button', {name: 'All'}).click();
  await page.getByRole('button', {name: 'Follow', pressed: false}).waitFor();
  await until('all of the world', async () => !await inTheMiddle());

  await page.getByText('Inputs and outputs').click();
  await page.getByLabel('Input pin 2').click();
  await page.getByLabel('Analog').fill('51');
  await page.getByText('1.00 V').waitFor();
  await until('the pin', () => page.getByLabel('Input pin 2').isChecked());

  await page.getByRole('button', {name: 'Disconnect'}).click();
  await watcher.locator('.link.live').waitFor();  // the bridge connects again by itself

  await stranger.goto(address.replace(/\/#.*/, '/simulator.html'));
  await stranger.getByText('Without the key you may watch').waitFor();
  assert.equal(await stranger.getByRole('button', {name: 'Pause'}).isDisabled(), true);

  const worlds = page.locator('label', {hasText: /^World/}).locator('select');
  // The list is read anew when it is opened.
  await page.evaluate(() => {
    const send = WebSocket.prototype.send;
    window.sent = [];
    WebSocket.prototype.send = function (data) {
      window.sent.push(data);
      this.addEventListener('message', event => { if (JSON.parse(event.data).type === 'files') window.files = event.data; });
      return send.call(this, data);
    };
  });
  await worlds.focus();
  const files = await until('the list of worlds', () => page.evaluate(() => window.files));
  assert.deepEqual(await page.evaluate(() => window.sent), ['{"do":"files"}']);
  assert.ok(JSON.parse(files).worlds.includes('arena'));
  await worlds.selectOption('arena');
  await page.getByRole('button', {name: 'Load'}).click();
  await until('another world', async () => await worlds.inputValue() === 'arena' && (await at())[0] < 11);
  await watcher.locator('.link.live').waitFor();
  for (const each of [page, stranger, watcher]) await leave(each);
});
