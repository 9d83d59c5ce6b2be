// The list of robots: the address of each one's own page, from here.
import type {RobotRow} from './types';

// Whoever is on the bus gives the address. Undefined: it is that of no page.
function pageAt(address: string): URL | undefined {
  try {
    const page = new URL(address);
    return /^https?:$/.test(page.protocol) ? page : undefined;
  } catch {
    return undefined;
  }
}

// address: empty where no browser on this machine reaches it; then `why`. here: of this page; host: the machine of its console.
export function wayTo(row: RobotRow, here: {hostname: string}, host: string): {address: string; why: string} {
  if (!row.address) return {address: '', why: 'It has no console.'};
  const page = pageAt(row.address), local = /^(localhost|127\.\d+\.\d+\.\d+|\[::1\])$/;
  if (!page) return {address: '', why: 'The address that its console gives is that of no page.'};
  if (page.hostname !== 'localhost') {
    // The same machine by the name that this browser knows.
    if (row.host === host && page.protocol === 'http:') page.hostname = here.hostname;
    return {address: page.href, why: ''};
  }
  return row.host === host && local.test(here.hostname) ? {address: page.href, why: ''}
    : {address: '', why: `Its page is for its own machine alone (${row.host}): saphira console --listen 0.0.0.0`};
}
