// The release table: each way of letting go, and of not being heard letting go, in Chromium. After it the page
// sends nothing that moves, and the robot stands and stays so, by the simulator's trace. Prints the table, with
// the times until it stands.
import assert from 'node:assert/strict';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {chromium} from 'playwright-core';
import {end, inTime, rig, sleep, until} from './processes.mjs';

const folder = mkdtempSync(join(tmpdir(), 'saphira-release-'));
const robot = {children: []}, table = [];
let browser, page, devtools, forth = false;

before(async () => {
  await rig(robot, folder, `release-${process.pid}`);
  browser = await chromium.launch({executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-dev-shm-usage']});
});
after(async () => {
  await browser?.close();
  for (const child of robot.children) await end(child);
  rmSync(folder, {recursive: true, force: true});
  console.log(`\n| held | what happens | until it stands [s] |\n| --- | --- | --- |\n${table.join('\n')}`);
});

async function openPage(script = () => {}, hasTouch = true) {
  const context = await browser.newContext({viewport: {width: 1280, height: 800}, reducedMotion: 'reduce', hasTouch});
  await context.addInitScript(() => {
    window.pads = [];
    navigator.getGamepads = () => window.pads;
  });
  await context.addInitScript(script);
  page = await context.newPage();
  devtools = await context.newCDPSession(page);
  await page.goto(robot.address);
  await page.locator('.link.live').waitFor();
  await page.evaluate(() => {
    window.samples = [];   // whether each moves the robot
    const send = saphira.sendSample.bind(saphira);
    saphira.sendSample = sample => {
      window.samples.push(sample.active);
      send(sample);
    };
  });
}
// From now on nothing that the page sends moves the robot.
const sent = () => page.isClosed() ? 0 : page.evaluate(() => window.samples.length);
const moving = from => page.isClosed() ? 0 : page.evaluate(from => window.samples.slice(from).filter(active => active).length, from);
const mine = () => page.evaluate(() => saphira.id !== 0 && saphira.data('console/control')?.holder === saphira.id);

// The events of a real keyboard: a place, and the letter that the layout has there.
const modifiers = {AltLeft: [1, 'Alt'], AltRight: [1, 'AltGraph'], ControlLeft: [2, 'Control'], MetaLeft: [4, 'Meta'], ShiftLeft: [8, 'Shift']};
let pressed = 0;
async function key(type, code, letter, autoRepeat = false) {
  const [bit, name] = modifiers[code] ?? [0, letter ?? code.slice(-1).toLowerCase()];
  pressed = type === 'keyDown' ? pressed | bit : pressed & ~bit;
  await devtools.send('Input.dispatchKeyEvent', {type: type === 'keyDown' ? 'rawKeyDown' : type, code, key: name, modifiers: pressed, autoRepeat});
}
const down = (code, letter) => key('keyDown', code, letter), up = (code, letter) => key('keyUp', code, letter);
const touch = (type, ...points) => devtools.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([x, y], id) => ({x, y, id}))});
const middle = async place => {
  const box = await page.locator(place).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
};
const happens = (type, target = 'window') => page.evaluate(([type, target]) => (target === 'window' ? window : document).dispatchEvent(new Event(type)), [type, target]);
const pad = (i, buttons, more = {}) => page.evaluate(([i, buttons, y, more]) => {
  window.pads[i] = {index: i, connected: true, timestamp: performance.now(), axes: [0, y],
                    buttons: Array.from({length: 16}, (_, b) => ({pressed: buttons.includes(b)})), ...more};
}, [i, buttons, forth ? -1 : 1, more]);

// The hands: to and fro, so that there is always room.
const byKey = (letters = ['i', 'm']) => ({
  name: letters[0] === 'i' ? 'key' : `key ${letters[0]}`,
  hold: () => down(forth ? 'KeyI' : 'KeyM', letters[forth ? 0 : 1]),
  drop: (changed = letters) => up(forth ? 'KeyI' : 'KeyM', changed[forth ? 0 : 1]),
});
const keys = byKey();
const stick = {
  name: 'stick, mouse',
  hold: async () => {
    const [x, y] = await middle('svg.stick');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y + (forth ? -50 : 50));
  },
  drop: () => page.mouse.up(),
};
const finger = {
  name: 'stick, finger',
  at: [0, 0],
  hold: async () => {
    const [x, y] = await middle('svg.stick');
    await touch('touchStart', [x, y]);
    await touch('touchMove', finger.at = [x, y + (forth ? -50 : 50)]);
  },
  drop: () => touch('touchEnd'),
};
const byPad = (name, more, button) => ({
  name,
  hold: async () => {
    await page.evaluate(() => { window.pads = []; });
    await pad(0, [], more);
    await sleep(200);   // it is seen with nothing held
    await pad(0, [button], more);
  },
  drop: () => pad(0, [], more),
});
const shoulder = byPad('gamepad, shoulder button', {id: 'Some pad (Vendor: 1)', mapping: 'standard'}, 5);
const trigger = byPad('joystick, trigger', {id: 'Test Joystick (Vendor: 2)', mapping: ''}, 0);

// Holds until the robot moves. A busy machine breaks the chain of samples now and then: again.
async function drives(hand) {
  forth = !forth;
  await until(`it drives by ${hand.name}`, async () => {
    if (!await mine()) await page.evaluate(() => saphira.send({type: 'take', force: true}));
    await until('control', mine);
    await hand.hold();
    for (const end = Date.now() + 2000; Date.now() < end; await sleep(20)) if (robot.speed() > 0.1) return true;
    await hand.drop();
    await sleep(300);
    return false;
  });
}
// `act` begins when the hand is let go, or returns the cycle from which on it may no longer be trusted.
const row = (hand, what, act) => test(`${hand.name}: ${what}`, async () => {
  try {
    await drives(hand);
    const now = robot.now(), later = await act(now), from = typeof later === 'number' ? later : now, last = await sent();
    await until('that it stands', () => robot.stood(from) !== undefined);
    await until('that it stays', () => robot.now() > from + 10 * robot.stood(from) + 6);
    if (typeof later !== 'number') assert.equal(await moving(last), 0, 'samples that move the robot');
    assert.ok(!robot.drivesOn(from), 'it stood, and moved on');
    const stands = robot.stood(from);
    table.push(`| ${hand.name} | ${what} | ${stands.toFixed(1)} |`);
    inTime(stands);
  } finally {
    if (!page.isClosed()) {
      await hand.drop().catch(() => {});   // nothing is held any more
      await page.evaluate(() => document.activeElement.blur());
    }
  }
});
const focus = what => page.locator(what).first().focus();

test('the page opens', () => openPage());
row(keys, 'let go', () => keys.drop());
for (const code of ['ControlLeft', 'AltLeft', 'AltRight', 'MetaLeft', 'ShiftLeft'])
  row(keys, `let go while ${modifiers[code][1]} is down`, async () => {
    await down(code);
    await keys.drop();
    await up(code);
  });
row(keys, 'Meta is pressed, and takes the release', async () => {
  await down('MetaLeft');
  await up('MetaLeft');
});
for (const [name, what] of [['text field', 'input[placeholder], input[list]'], ['slider', '#speed'], ['tab', '[role=tab][aria-selected=true]'], ['summary', 'summary'], ['button', 'button.main']])
  row(keys, `let go with the focus on a ${name}`, async () => {
    await focus(what);
    await keys.drop();
  });
row(keys, 'the focus goes into a text field, and the release is not heard', () => focus('input[placeholder], input[list]'));
row(keys, 'a list opens', async () => {
  await page.evaluate(() => document.body.append(document.createElement('select')));
  await focus('body > select');
  await page.evaluate(() => document.querySelector('body > select').remove());
});
row(keys, 'let go after the layout has changed', () => keys.drop(['ш', 'ь']));
row(keys, 'let go with Shift, by a capital letter', () => keys.drop(['I', 'M']));
for (const letters of [['ш', 'ь'], ['ι', 'μ'], ['c', 'm'], ['Dead', 'Process']]) {
  const others = byKey(letters);
  row(others, 'let go', () => others.drop());
  row(others, 'the key at the place of k', async () => {
    await down('KeyK', 'л');
    await up('KeyK', 'л');
  });
}
row(keys, 'let go, while another key is held on', async () => {
  await down('KeyX');
  await keys.drop();
  await up('KeyX');
});
row(keys, 'a release of a key that was never pressed (Fn)', () => up('PageUp', 'PageUp'));
row(keys, 'its repeats end, and the release is not heard', async () => {
  for (let i = 0; i < 20; ++i) {
    await sleep(33);
    await key('keyDown', forth ? 'KeyI' : 'KeyM', undefined, true);
  }
  return robot.now();
});
for (const hand of [keys, stick, finger, shoulder]) {
  row(hand, 'the window loses the focus', async () => {
    await happens('blur');
    await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();   // it only watches now
  });
}
row(keys, 'a question of the browser stops the page', async () => {
  page.once('dialog', async dialog => {
    await sleep(1000);
    await dialog.dismiss();
  });
  await page.evaluate(() => alert('a question'));
});
row(keys, 'the page is hidden', () => page.evaluate(() => {
  Object.defineProperty(document, 'hidden', {get: () => true, configurable: true});
  document.dispatchEvent(new Event('visibilitychange'));
  delete document.hidden;
}));
row(keys, 'a menu opens', () => page.mouse.click(400, 300, {button: 'right'}));
row(keys, 'something is dragged', () => happens('dragstart'));
row(stick, 'let go', () => stick.drop());
row(stick, 'let go outside the window', async () => {
  await page.mouse.move(-50, 900);
  await stick.drop();
});
row(stick, 'the capture of the pointer is lost', () => page.evaluate(() => {
  const stick = document.querySelector('svg.stick'), lost = new Promise(tell => stick.addEventListener('lostpointercapture', tell));
  for (let id = 0; id < 100; ++id) if (stick.hasPointerCapture(id)) stick.releasePointerCapture(id);
  return lost.then(() => {});
}));
row(finger, 'let go', () => finger.drop());
row(finger, 'let go beyond the edge', async () => {
  await touch('touchMove', [-20, 900]);
  await finger.drop();
});
row(finger, 'the system takes the touch', () => touch('touchCancel'));
row(finger, 'a second finger taps STOP', async () => {
  await touch('touchStart', finger.at, await middle('.estop'));
  await page.getByRole('alert').filter({hasText: 'Emergency stop'}).waitFor();
});
test('STOP works at the touch, before a click, and once', async () => {
  const reset = () => until('the reset', async () => {
    await page.evaluate(() => saphira.send({type: 'estop_reset'}));
    return !await page.getByRole('alert').count();
  });
  await reset();
  await page.evaluate(() => {
    window.presses = 0;
    const estop = saphira.estop.bind(saphira);
    saphira.estop = () => ++window.presses && estop();
  });
  for (const press of [() => page.locator('.estop').click(), () => page.locator('.estop').tap(), () => page.locator('.estop').press('Enter')]) {
    await press();
    await page.getByRole('alert').filter({hasText: 'Emergency stop'}).waitFor();
    await reset();
  }
  assert.equal(await page.evaluate(() => window.presses), 3);
  await page.evaluate(() => document.activeElement.blur());
});
for (const hand of [shoulder, trigger]) {
  row(hand, 'let go', () => hand.drop());
  row(hand, 'unplugged', async () => {
    await page.evaluate(() => { window.pads = []; });
    await happens('gamepaddisconnected');
  });
  row(hand, 'gone from the browser without a word', () => page.evaluate(() => { window.pads = []; }));
}
row(shoulder, 'another gamepad is held on', async () => {
  await pad(1, [5], {id: 'Other pad (Vendor: 1)', mapping: 'standard'});
  await sleep(100);
  await page.evaluate(() => { window.pads[0] = null; });
});
row(shoulder, 'says nothing for 5 s', async from => {
  await until('5 s', () => robot.now() - from >= 50);
  return robot.now();
});

test('a gamepad whose buttons have no names does not drive, and says so', async () => {
  for (const id of ['Test device (Vendor: 3)', 'Generic USB Joystick']) {
    for (let button = 0; button < 16; ++button) {
      await pad(0, [button], {id, mapping: ''});
      await sleep(60);
      assert.ok(robot.speed() < 0.01, `button ${button} of ${id}`);
    }
    await page.getByText('its buttons have no names here, so it does not drive').waitFor();
  }
  await trigger.drop();
  await page.getByText('Gamepad Test Joystick: hold the trigger').waitFor();
  await shoulder.drop();
  await page.getByText('Gamepad Some pad: hold a shoulder button').waitFor();
});
row(stick, 'the stick goes from the page', () => page.evaluate(() => document.querySelector('svg.stick').remove()));
row(keys, 'the page is closed', () => page.close());

test('the letters on the page are those of the keyboard; a page without gamepads says so', async () => {
  await openPage(() => {
    Object.defineProperty(navigator, 'keyboard', {value: {getLayoutMap: async () => new Map([['KeyI', 'c'], ['KeyK', 't'], ['Period', 'v']])}});
    Object.defineProperty(window, 'isSecureContext', {value: false});
    navigator.getGamepads = undefined;
  }, false);
  await until('control', async () => {
    await page.evaluate(() => saphira.send({type: 'take', force: true}));
    return mine();
  });
  await page.getByText('Keys, held down').waitFor();
  assert.deepEqual((await page.locator('.drive kbd').allInnerTexts()).slice(0, 6), ['c', 'm', 'j', 'l', 'v', 't']);
  await page.getByText('gives this page no gamepad; some browsers give one only to a page by https').waitFor();
  await page.close();
  await openPage(() => { Object.defineProperty(navigator, 'keyboard', {value: undefined}); }, false);
  await until('control', async () => {
    await page.evaluate(() => saphira.send({type: 'take', force: true}));
    return mine();
  });
  await page.getByText('Keys, at their places on a US keyboard, held down').waitFor();
  assert.equal(await page.locator('.drive kbd').first().innerText(), 'i');
  await page.getByText('A gamepad shows once one of its buttons is pressed.').waitFor();
});
