// Events of the robot as the browser's notifications, for people who look elsewhere.
import {store, stored} from './address';

const wanted = 'saphira-notify';

// [undefined: the browser has none for this page, which needs https or this machine]
export const notifies = () => typeof Notification === 'undefined' || !isSecureContext ? undefined
  : stored(wanted) === 'yes' && Notification.permission === 'granted';

// Asks the person where the browser wants that.
export async function wantNotifications(on: boolean): Promise<boolean> {
  const may = on && await Notification.requestPermission() === 'granted';
  store(wanted, may ? 'yes' : '');
  return may;
}

export function notify(robot: string, text: string) {
  if (!notifies() || !document.hidden) return;
  navigator.vibrate?.(200);
  const told = new Notification(robot, {body: text, tag: text});
  told.onclick = () => {
    focus();
    told.close();
  };
}
