// Tickets: leave to see one session, carried in the address of everything that shows it.

const FORM = /^rst_[0-9a-f]{16,128}$/;

/** The ticket in an address, empty if there is none. */
export function ticketIn(address: string): string {
  const ticket = new URL(address).searchParams.get('ticket') ?? '';
  return FORM.test(ticket) ? ticket : '';
}

/** An address with a ticket; without one it stays as it is. */
export function withTicket(address: string, ticket: string): string {
  if (ticket === '') return address;
  const url = new URL(address);
  url.searchParams.set('ticket', ticket);
  return url.href;
}
