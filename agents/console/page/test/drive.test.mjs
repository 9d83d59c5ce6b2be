// Driving by the page: one person after another, and what is lost on the way.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import net from 'node:net';
import {join} from 'node:path';
import {test} from 'node:test';
import {address, leave, machine, moves, open, person, send, speed, stands, up} from './browser.mjs';
import {sleep, until} from './processes.mjs';
import {socketTo} from './socket.mjs';

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
const childrenOf = pid => readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8').trim().split(' ').filter(child => child);
const familyOf = pid => [pid, ...childrenOf(pid).flatMap(familyOf)];
async function gatewayProcess() {
  return until('the console process', async () => {
    for (const pid of childrenOf(up.pid))
      if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').startsWith(join(process.env.SAPHIRA_BIN_DIR, 'saphira-console') + '\0')) return Number(pid);
    return undefined;
  });
}

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
  const lanes = page => page.evaluate(() => saphira.lanes.length);
  await until('only who drives has the further connections', async () => await lanes(ann) === 0 && await lanes(bob) === 5);
  await ann.getByText('has control').waitFor();
  await ann.keyboard.up('i');
  await handBack(bob);
  await leave(ann);
  await leave(bob);
});

test('k ends whatever moves the robot, also by somebody who has neither control nor key', async () => {
  const page = await person(), guest = await person();
  await open(page);
  await open(guest, false);
  for (const stopper of [page, guest]) {
    await send(page, 'drive 0.2');
    await moves(page);
    await stopper.locator('canvas').focus();
    await stopper.keyboard.press('k');
    await stopper.getByText('the robot is at rest').waitFor();
    await stands(page);
    await page.getByText('stopped by').first().waitFor();
  }
  await leave(page);
  await leave(guest);
});

test('everybody may stop the robot, also without the key', async () => {
  const ann = await person(), guest = await person();
  await open(ann);
  await open(guest, false);
  await guest.getByText('You watch').waitFor();
  assert.equal(await guest.getByRole('button', {name: 'Drive', exact: true}).count(), 0);
  assert.ok(await guest.getByRole('button', {name: 'Send'}).isDisabled());
  await guest.getByRole('button', {name: 'Emergency stop'}).click();
  for (const page of [ann, guest])
    await page.getByRole('alert').filter({hasText: 'pressed by a visitor without a key at the console'}).waitFor();
  assert.ok(await guest.getByRole('button', {name: 'Reset'}).isDisabled());
  const reset = async () => {
    await ann.getByRole('button', {name: 'Reset'}).click();
    await until('the reset', async () => !(await ann.getByRole('alert').count()));
  };
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
